"""The rule of a run's length: at least one step, and no more than can be simulated and kept."""

from __future__ import annotations

from fractions import Fraction

from lavendersim.clock import Clock
from lavendersim.experiment.text.node import Node
from lavendersim.experiment.text.place import Place
from lavendersim.quantities.scalars import exact

MOST_STEPS = 100_000_000  # 1e8 steps of a small scene take minutes and log tens of gigabytes


def step_rules(at: Place) -> None:
    """Refuse a duration that is too many steps, or less than one."""
    duration, written = at.get("duration"), at.get("numerics", "timestep")
    clock, number = _clock(at.node), at.node.number_at("duration")
    if clock is None or duration is None or number is None or number <= 0 or written is None:
        return
    length, timestep = exact(number), clock.timestep
    mark = max(duration.mark, written.mark)  # swept values stand below what they replace
    steps = Fraction(clock.steps_until(length)) if clock.changes else length / timestep
    step = str(timestep) if timestep.denominator < 10_000 else _short(timestep)
    if steps > MOST_STEPS:
        lengths = "of changing length" if clock.changes else f"of {step} s"
        counted = f"{_short(length)} s in steps {lengths} are {_short(steps)} steps"
        at.refuse(mark, f"{counted}, expected at most {_short(Fraction(MOST_STEPS))}")
    elif round(steps) < 1:
        at.refuse(mark, f"a duration of {_short(length)} s is less than one step of {step} s")


def _clock(root: Node) -> Clock | None:
    """Return the clock that applies to this tree, None where a time or a timestep is wrong."""
    first = root.number_at("numerics", "timestep")
    changes = []
    for event in root.items_at("events"):
        written = event.get("timestep")
        if written is None or written.content is None:
            continue
        at, timestep = event.number_at("at"), written.number
        if at is None or at < 0 or timestep is None or timestep <= 0:
            return None
        changes.append((exact(at), exact(timestep)))
    return Clock(exact(first), changes) if first is not None and first > 0 else None


def _short(number: Fraction) -> str:
    try:
        return f"{float(number):g}".replace("e+0", "e").replace("e+", "e")
    except OverflowError:
        return "more than 1e308"
