"""The rules of steps: how many there are, and under which numerics their errors are estimated."""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import Any, Final

from lavendersim.clock import Clock
from lavendersim.experiment.text.node import Node
from lavendersim.experiment.text.place import Place
from lavendersim.quantities.scalars import exact

MOST_STEPS = 100_000_000  # 1e8 steps of a small scene take minutes and log tens of gigabytes
# Steps of order 2, impacts at their times: else halves of a step tell nothing of its error.
_LAWS: Final = (("impacts", "in_order"), ("integrator", "midpoint_contact"))


def step_rules(at: Place) -> None:
    """Refuse a duration that is too many steps, or less than one."""
    duration, written = at.get("duration"), at.get("numerics", "timestep")
    clock, number = _clock(at.node), duration.number
    if clock is None or number is None or number <= 0:
        return
    length, timestep = exact(number), clock.timestep
    steps = Fraction(clock.steps_until(length)) if clock.changes else length / timestep
    step = str(timestep) if timestep.denominator < 10_000 else _short(timestep)
    if steps > MOST_STEPS:
        lengths = "of changing length" if clock.changes else f"of {step} s"
        counted = f"{_short(length)} s in steps {lengths} are {_short(steps)} steps"
        at.refuse_pair(
            duration, written, f"{counted}, expected at most {_short(Fraction(MOST_STEPS))}"
        )
    elif round(steps) < 1:
        sentence = f"a duration of {_short(length)} s is less than one step of {step} s"
        if timestep.denominator == 1 and timestep > 1:
            sentence += f"; did you mean timestep: 1/{timestep}?"
        at.refuse_pair(duration, written, sentence)


def _clock(root: Node) -> Clock | None:
    """Return the clock that applies to this tree, None where a time or a timestep is wrong."""
    first = root.get("numerics", "timestep").number
    changes = []
    for event in root.get("events").items:
        written = event.get("timestep")
        if written.content is None:
            continue
        at, timestep = event.get("at").number, written.number
        if at is None or at < 0 or timestep is None or timestep <= 0:
            return None
        changes.append((exact(at), exact(timestep)))
    return Clock(exact(first), changes) if first is not None and first > 0 else None


def _short(number: Fraction) -> str:
    try:
        return f"{float(number):g}".replace("e+0", "e").replace("e+", "e")
    except OverflowError:
        return "more than 1e308"


def is_of_order_two(numerics: Mapping[str, Any]) -> bool:
    """Whether the errors of substeps can be estimated under these numerics."""
    laws = all(numerics[key] == needed for key, needed in _LAWS)
    return laws and not numerics["stabilisation_gain"] > 0


def accuracy_rules(at: Place) -> None:
    """Refuse an accuracy beside laws of lower order, and bounds of substeps that exclude all."""
    numerics = at.get("numerics")
    accuracy = numerics.get("accuracy")
    if accuracy.content is None:
        return
    needs: list[tuple[Node, str]] = []
    for key, needed in _LAWS:
        value = numerics.get(key)
        if value and value.text != needed:
            needs.append((value, f"{key}: {needed}, found {value.text}"))
    gain, tolerance = numerics.get("stabilisation_gain"), numerics.get("tolerance")
    if gain.number is not None and gain.number > 0.0:
        needs.append((gain, f"stabilisation_gain: 0, found {gain.number:g}"))
    if tolerance and tolerance.content is None:
        needs.append((tolerance, "a tolerance, by which steps are solved; found null"))
    for value, sentence in needs:
        at.refuse_pair(accuracy, value, f"accuracy: needs {sentence}")
    smallest = numerics.get("smallest_timestep")
    longest = numerics.get("timestep").number or math.inf
    if smallest.number is not None and smallest.number > longest:
        found = f"expected at most the timestep, {float(longest):g} s, found {smallest.number:g}"
        at.refuse_pair(accuracy, smallest, f"smallest_timestep: {found}")
