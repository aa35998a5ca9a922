"""The laws of logs that lavender wrote: none is broken, and the impulses are those of the solver.

With `semi_implicit_euler` all contacts push where a step begins: the problem that is judged is the
solver's own, and agrees with it to round-off. By default contacts that last push half way through
parts of a step, impacts where bodies meet: that is of second order in the turn of a step.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lavendersim import open_trace
from lavendersim.experiment.load import load_experiment_text
from lavendersim.laws.contacts import ContactSearch
from lavendersim.laws.fits import fits_of
from lavendersim.laws.judging import AT_START, EVERYWHERE, judge_laws, looks_of
from lavendersim.laws.momentum import BodyStates, momentum_of
from lavendersim.laws.motion import RecordedMotion, motion_of
from lavendersim.laws.points import points_at
from lavendersim.runner import run
from lavendersim.trace import Trace

# A ball that falls on a box on a floor, both with friction: impacts, sliding, spin.
TEXT = """\
question: Are the laws kept?
expected: They are.
scene:
  surfaces: {{s: {{friction: 0.5, restitution: 0.3}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: s}}
    {bodies}
numerics: {{timestep: 1/{rate}{numerics}}}
duration: {duration}
record: {{velocities: true}}
"""
BALL = "ball: {shape: {kind: sphere, radius: 0.1}, mass: 2, surface: s, position: [0, 0, 0.15], \
velocity: [1, 0.3, 0], angular_velocity: [0, 3, 2]}"
BOX = "box: {shape: {kind: box, size: [0.2, 0.3, 0.4]}, mass: 1, surface: s, \
position: [0, 0, 0.25], velocity: [1, 0.3, 0], angular_velocity: [0.3, 0.2, 2]}"
AT_THE_START = ", integrator: semi_implicit_euler, impacts: captured, speculative: false"


def logged(folder: Path, bodies: str, numerics: str, rate: int = 240, time: float = 0.4) -> Trace:
    text = TEXT.format(bodies=bodies, numerics=numerics, rate=rate, duration=time)
    finished = run(load_experiment_text(text, "laws.yaml"), root=folder)
    return open_trace(finished.run.cells[0].path)


def share(motion: RecordedMotion, *laws: str) -> float:
    judged = judge_laws(motion)
    return max(float(judged.shares[law].max()) for law in laws)


@pytest.fixture(scope="module")
def from_the_start(tmp_path_factory: pytest.TempPathFactory) -> Trace:
    return logged(tmp_path_factory.mktemp("start"), BALL, AT_THE_START)


def test_of_the_scheme_that_pushes_at_the_start_laws_hold_to_round_off(
    from_the_start: Trace,
) -> None:
    """Momentum as `always` has it: a thousand roundings of 1e-16; velocities to the tolerance."""
    motion = motion_of(from_the_start)
    assert looks_of(motion) == AT_START
    assert share(motion, "momentum", "adhesion", "cone", "gap") < 1e-13
    # One contact solved to 1e-9 m/s, at play some 1 m/s.
    assert share(motion, "complementarity", "dissipation", "energy") < 1e-8


def test_impulses_velocities_and_violations_are_those_of_the_solver(from_the_start: Trace) -> None:
    """One contact, so its impulse is unique; all numbers are of order 1."""
    motion, contacts, steps = motion_of(from_the_start), from_the_start.contact, 0
    search = ContactSearch(motion)
    for row, step in enumerate(motion.steps[1:].tolist(), start=1):
        logged_row = contacts[contacts["step"] == step]
        if len(logged_row) == 0:
            continue
        (row_of_log,) = logged_row
        before, after = (BodyStates(motion.pose[k], motion.velocity[k]) for k in (row - 1, row))
        dt = float(motion.clock.length(step))
        momentum = momentum_of(search, before, after, dt)
        points = points_at(search, 0.0, (before, after), momentum, dt)
        (impulse,) = fits_of(momentum, [points]).impulses
        n, one, two = impulse
        w_n, w_1, w_2 = points.after[0]
        names = ("impulse_n", "impulse_t1", "impulse_t2", "normal_velocity", "slip_t1", "slip_t2")
        of_log = [float(row_of_log[name]) for name in names]
        assert [n, one, two, w_n, w_1, w_2] == pytest.approx(of_log, abs=1e-12)
        of_step = from_the_start.step[row]
        cone = max(np.hypot(one, two) - 0.5 * n, -n)
        slip = np.hypot(w_1, w_2)
        dissipation = abs(one * w_1 + two * w_2 + 0.5 * n * slip)
        assert max(cone, 0.0) == pytest.approx(float(of_step["cone"]), abs=1e-12)
        assert dissipation == pytest.approx(float(of_step["dissipation"]), abs=1e-12)
        steps += 1
    assert steps > 50


def test_of_the_default_scheme_a_ball_breaks_none(tmp_path: Path) -> None:
    """Its lever is the same wherever it touches; parts of steps end where sliding stops."""
    motion = motion_of(logged(tmp_path, BALL, ""))
    assert looks_of(motion) == EVERYWHERE
    assert share(motion, "momentum", "adhesion", "cone", "gap") < 1e-12
    assert judge_laws(motion).named is None


def test_of_the_default_scheme_a_box_is_within_the_square_of_its_turn(tmp_path: Path) -> None:
    """Levers of any time are those of four poses but for phi^2/2 of their length, phi = omega dt.

    So much of the momentum at play is missing at the most. The box tumbles, strikes corner by
    corner and comes to rest; its spin stays below 5 rad/s, phi below 0.02.
    """
    motion = motion_of(logged(tmp_path, BOX, "", time=0.5))
    turn = float(np.linalg.norm(motion.velocity[:, 1, 3:], axis=1).max()) / 240
    assert turn < 0.02
    assert share(motion, "momentum", "adhesion", "cone", "gap") < turn**2 / 2
    assert judge_laws(motion).named is None


def test_the_rows_of_a_table_are_those_of_the_steps(from_the_start: Trace) -> None:
    judged = judge_laws(motion_of(from_the_start))
    table, rows = judged.table(), judged.rows()
    assert table["steps"] == len(rows["step"]) == 96
    assert table["laws"]["penetration"]["worst"] == max(rows["numbers"]["penetration"])
    assert table["laws"]["penetration"]["unit"] == "m"
