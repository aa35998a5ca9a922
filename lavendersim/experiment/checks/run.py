"""Checks of events, forces, the run's length and its record, against scene and numerics.

Works on the tree, and says nothing about values of a wrong type: those are refused elsewhere.
"""

from __future__ import annotations

from fractions import Fraction

from lavendersim.clock import Clock
from lavendersim.experiment.checks.cost import check_cost
from lavendersim.experiment.checks.events import check_events
from lavendersim.experiment.checks.messages import place_of
from lavendersim.experiment.checks.population import body_node
from lavendersim.experiment.checks.scene import is_kinematic, is_static, kind_of
from lavendersim.experiment.text.node import Node, key_mark
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.scalars import exact

# Solvers that no sweep visits contact by contact.
_WITHOUT_SWEEPS = ("jacobi", "accelerated_projected_gradient")
MOST_STEPS = 100_000_000  # 1e8 steps of a small scene take minutes and log tens of gigabytes


def check_run(root: Node, report: Report) -> None:
    """Note what is wrong between duration, timestep, events and record."""
    duration = root.get("duration")
    length = duration.number if duration is not None else None
    if duration is not None and length is not None and length > 0:
        _check_steps(root, duration, exact(length), report)
    check_events(root, length, report)
    forces = root.get("scene", "forces")
    for index, force in enumerate(forces.items if forces is not None else ()):
        if force.entries:
            _check_force(force, index, root, length, report)
    window = root.get("record", "residuals")
    if window is not None and window.entries:
        _check_window(window, length, report)
    _check_sweeps(root, report)
    _check_price(root, length, report)
    check_cost(root, length, report)


def timestep_of(root: Node) -> Fraction | None:
    """Return the timestep [s] of this tree, None where it is no positive number."""
    timestep = root.get("numerics", "timestep")
    number = timestep.number if timestep is not None else None
    return exact(number) if number is not None and number > 0 else None


def clock_of(root: Node) -> Clock | None:
    """Return the clock that holds for this tree, None where a time or a timestep is wrong."""
    timestep = timestep_of(root)
    events = root.get("events")
    changes = []
    for event in events.items if events is not None else ():
        stated = event.get("timestep")
        if stated is not None and stated.content is not None:
            at = event.get("at")
            numbers = (at.number if at is not None else None, stated.number)
            if numbers[0] is None or numbers[0] < 0 or numbers[1] is None or numbers[1] <= 0:
                return None
            changes.append((exact(numbers[0]), exact(numbers[1])))
    return Clock(timestep, changes) if timestep is not None else None


def _check_steps(root: Node, duration: Node, length: Fraction, report: Report) -> None:
    clock = clock_of(root)
    if clock is None:
        return
    timestep = clock.timestep
    stated = root.get("numerics", "timestep") or duration
    mark = max(duration.mark, stated.mark)  # swept values stand below what they replace
    steps = Fraction(clock.steps_until(length)) if clock.changes else length / timestep
    step = str(timestep) if timestep.denominator < 10_000 else _short(timestep)
    if steps > MOST_STEPS:
        lengths = "of changing length" if clock.changes else f"of {step} s"
        counted = f"{_short(length)} s in steps {lengths} are {_short(steps)} steps"
        report.add(mark, f"{counted}, expected at most {_short(Fraction(MOST_STEPS))}")
    elif round(steps) < 1:
        report.add(mark, f"a duration of {_short(length)} s is less than one step of {step} s")


def _short(number: Fraction) -> str:
    try:
        return f"{float(number):g}".replace("e+0", "e").replace("e+", "e")
    except OverflowError:
        return "more than 1e308"


def _check_force(force: Node, index: int, root: Node, length: float | None, report: Report) -> None:
    body, begin, end = force.get("body"), force.get("from"), force.get("to")
    if body is not None and body.text is not None:
        target = body_node(root, body.text)
        if target is not None and (is_static(target) or is_kinematic(target)):
            what = "kinematic" if is_kinematic(target) else "fixed"
            what = "a plane" if kind_of(target) == "plane" else what
            report.add(body.mark, f'body: "{body.text}" is {what}; expected a movable body')
    if not force.get("force") and not force.get("torque"):
        sentence = f"{place_of(('scene', 'forces', index))} does nothing; expected force or torque"
        report.add(force.mark, sentence)
    start = 0.0 if begin is None else begin.number
    if begin is not None and start is not None and length is not None and start > length > 0:
        sentence = f"from: {start:g} s is after the end of the run, duration {length:g} s"
        report.add(begin.mark, sentence)
    elif end is not None and end.number is not None and start is not None and end.number <= start:
        sentence = f"to: expected a time after from ({start:g} s), found {end.number:g}"
        report.add(end.mark, sentence)


def _check_window(window: Node, length: float | None, report: Report) -> None:
    begin, end = window.get("from"), window.get("to")
    if begin is None or end is None or begin.number is None or end.number is None:
        return
    if begin.number >= end.number:
        sentence = f"to: expected a time after from ({begin.number:g} s), found {end.number:g}"
        report.add(end.mark, sentence)
    elif length is not None and begin.number > length:
        sentence = f"from: {begin.number:g} s is after the end of the run, duration {length:g} s"
        report.add(begin.mark, sentence)


def _check_sweeps(root: Node, report: Report) -> None:
    """What is said of sweeps must be said to a solver that makes some."""
    solver = root.get("numerics", "solver")
    if solver is None or solver.text not in _WITHOUT_SWEEPS:
        return
    for key, idle in (("over_relaxation", "1"), ("order", "coloured")):
        stated = root.get("numerics", key)
        if stated is None or stated.text == idle or stated.number == 1:
            continue
        mark = max(solver.mark, stated.mark)  # swept values stand below what they replace
        sentence = f"{key}: {solver.text} treats all contacts at once; expected {idle}"
        report.add(mark, sentence)


def _check_price(root: Node, length: float | None, report: Report) -> None:
    """Every sample is the same steps of one cell, in one go."""
    if root.get("price") is None:
        return
    for path, said in (
        (("sweep",), "sweep"),
        (("events",), "events"),
        (("scene", "forces"), "scene.forces"),
    ):
        other = root.get(*path)
        if other is not None and (other.entries or other.items):
            sentence = f"price: expected one cell without events and forces, found {said}"
            report.add(key_mark(root, "price"), sentence)
    begin = root.get("price", "from")
    start = begin.number if begin is not None else None
    if begin is not None and start is not None and length is not None and start >= length > 0:
        sentence = f"from: expected a time before the end (duration {length:g} s), found {start:g}"
        report.add(begin.mark, sentence)
