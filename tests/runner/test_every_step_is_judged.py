"""Section `always`: a right run keeps every law to round-off, and one broken step breaks its law.

Logs are taken from one run and falsified in one place: exactly the check that holds this law must
fail, and tell the first step, its time, the bodies and the command that shows it.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lavendersim
from lavendersim.measures import outcomes_of
from lavendersim.measures.specs.always import CHECKS, Always
from lavendersim.runner import Finished
from lavendersim.runner.bounds import Bounds
from lavendersim.trace import Block

# A ball slides to rolling; another is pushed and turned by a force and a torque, bounces, falls on
# the first, and is moved, thrown and made heavier by events.
SCENE = """\
scene:
  surfaces: {rubber: {friction: 0.3, restitution: 0.5}}
  bodies:
    floor: {shape: {kind: plane}, surface: rubber}
    low:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      surface: rubber
      position: [0, 0, 0.1]
      velocity: [1, 0, 0]
    high:
      shape: {kind: sphere, radius: 0.1}
      mass: 2.0
      surface: rubber
      position: [0.3, 0, 0.5]
  forces:
    - {body: high, from: 0.1, to: 0.7, force: [-4, 1, 1], torque: [0.1, 0, 0.2]}
events:
  - {at: 0.4, body: high, teleport: [0.5, 0, 0.7]}
  - {at: 0.42, body: high, velocity: [0, 0, -2]}
  - {at: 0.45, body: low, scale_mass: 3}
  - {at: 0.8, body: low, velocity: [-1, 0, 0], angular_velocity: [0, 5, 0]}
duration: 1.0
always: {speed: 20}
"""
BROKEN = 12  # step: at 0.05 s the low ball slides on the floor, up to 2 v / (7 mu g) = 0.097 s


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Finished:
    folder = tmp_path_factory.mktemp("kept")
    config = folder / "kept.yaml"
    config.write_text(SCENE)
    return lavendersim.run(config, root=folder)


class Falsified:
    """A log whose columns may be written to, and the cell it belongs to."""

    index, label, coordinates = 3, "e=0.5", {"e": 0.5}
    path = Path("runs/some-run/cells/some-cell.mcap")

    def __init__(self, trace: Any) -> None:
        self.step, self.pose, self.contact = trace.step.copy(), trace.pose.copy(), trace.contact
        self.contact = trace.contact.copy()
        self.bodies, self.clock = trace.bodies, trace.clock
        self.config, self.absent, self.status = trace.config, trace.absent, trace.status
        self.events = trace.events

    def trace(self) -> Any:
        return self

    def contacts_in_parts(self) -> Any:
        """In parts of whole steps, as a long log has them; one of the parts is empty."""
        cuts = np.searchsorted(self.contact["step"], [5, BROKEN, BROKEN, BROKEN + 1, 100])
        return iter(np.split(self.contact, cuts))

    def steps_in_parts(self) -> Any:
        """In parts, cut elsewhere; one of them is empty, too."""
        return iter(np.split(self.step, [1, BROKEN - 1, BROKEN - 1, 200]))

    def poses_in_parts(self) -> Any:
        """In parts of their own."""
        cuts = [BROKEN, BROKEN + 1, 150]
        return zip(np.split(self.step["step"], cuts), np.split(self.pose, cuts), strict=True)

    def sliding(self) -> int:
        """Row of the contact between floor and low ball in the step that is falsified."""
        return int(np.flatnonzero(self.contact["step"] == BROKEN)[0])


def test_a_right_run_keeps_every_law_to_round_off(finished: Finished) -> None:
    assert finished.good
    measured = {verdict.name: verdict.measured for verdict in finished.verdicts}
    assert list(measured) == [f"always: {check}" for check in CHECKS]
    # Each of 240 steps adds velocities some hundred times: 2^-53 * 240 * 100 = 3e-12 of what there
    # is. What penetrates is what a residual of 1e-9 m/s leaves over a second.
    assert measured["always: finite"] == 0.0
    assert measured["always: energy"] < 3e-12
    assert measured["always: momentum"] < 3e-12
    assert measured["always: impulses"] < 3e-12
    assert 1.0 < measured["always: speed"] < 20.0


def wins_energy(log: Falsified) -> None:
    # more than the mu m g v dt = 0.012 J that the low ball's friction takes in this step
    log.step["kinetic_energy"][BROKEN:] += 0.02


def moves_momentum(log: Falsified) -> None:
    log.step["momentum_y"][BROKEN] += 1e-6


def forgets_an_impulse(log: Falsified) -> None:
    log.contact["impulse_n"][log.sliding()] *= 1.001


def leaves_the_cone(log: Falsified) -> None:
    row = log.sliding()
    length = np.hypot(log.contact["impulse_t1"][row], log.contact["impulse_t2"][row])
    assert length == pytest.approx(0.3 * log.contact["impulse_n"][row], rel=1e-9)  # it slides
    log.contact["impulse_t1"][row] *= 1.0 + 1e-6
    log.contact["impulse_t2"][row] *= 1.0 + 1e-6


def sinks(log: Falsified) -> None:
    log.contact["penetration"][log.sliding()] = 0.021


def misses_the_tolerance(log: Falsified) -> None:
    log.step["residual"][BROKEN] = 1.1e-6


def jumps(log: Falsified) -> None:
    # 0.1 m within 1/240 s are 24 m/s; the way that the forces on `high` act along stays as it is
    log.pose[BROKEN:, log.bodies.index("low"), 1] += 0.1


def loses_a_number(log: Falsified) -> None:
    log.contact["target"][log.sliding()] = np.nan


BREAKS: dict[Callable[[Falsified], None], tuple[set[str], str]] = {
    wins_energy: ({"energy"}, ""),
    moves_momentum: ({"momentum"}, ""),
    forgets_an_impulse: ({"momentum"}, ""),
    leaves_the_cone: ({"impulses", "momentum"}, "floor and low"),
    sinks: ({"penetration"}, "floor and low"),
    misses_the_tolerance: ({"residual"}, "floor and low"),
    jumps: ({"speed"}, "low"),
    loses_a_number: ({"finite"}, ""),
}


@pytest.mark.parametrize("breaking", BREAKS, ids=lambda one: one.__name__)
def test_one_broken_step_breaks_exactly_its_law(
    finished: Finished, breaking: Callable[[Falsified], None]
) -> None:
    log = Falsified(finished.run.cells[0].trace())
    breaking(log)
    laws, bodies = BREAKS[breaking]
    outcomes = outcomes_of(Always(speed=20.0), log)
    assert {name for name, outcome in outcomes.items() if not outcome.passed} == laws
    for law in laws:
        reason = outcomes[law].reason
        assert f"first in step {BROKEN}, t = 0.05 s" in reason
        assert "lavender replay runs/some-run --cell 3 --at 0.05" in reason
    assert bodies in outcomes[min(laws)].reason


def pulls(log: Falsified) -> None:
    log.contact["impulse_n"][log.sliding()] *= -1e-6


def is_no_number(log: Falsified) -> None:
    for name in ("kinetic_energy", "momentum_x", "residual"):
        log.step[name][BROKEN] = np.nan
    log.contact["impulse_t1"][log.sliding()] = np.nan
    log.contact["penetration"][log.sliding()] = np.nan
    log.pose[BROKEN, log.bodies.index("low")] = np.nan


def test_a_pull_is_reported_with_its_bodies(finished: Finished) -> None:
    log = Falsified(finished.run.cells[0].trace())
    pulls(log)
    outcome = outcomes_of(Always(), log)["impulses"]
    assert not outcome.passed
    assert "floor and low" in outcome.reason


def test_a_number_that_is_none_passes_nothing(finished: Finished) -> None:
    log = Falsified(finished.run.cells[0].trace())
    is_no_number(log)
    outcomes = outcomes_of(Always(speed=20.0), log)
    assert [name for name, outcome in outcomes.items() if outcome.passed] == []


@pytest.mark.parametrize("breaking", [*BREAKS, pulls, is_no_number], ids=lambda one: one.__name__)
def test_a_run_tells_of_itself_what_its_log_tells(
    finished: Finished, breaking: Callable[[Falsified], None]
) -> None:
    """Kernels over the blocks of a run, however cut, and numpy over its log: the same outcomes."""
    log = Falsified(finished.run.cells[0].trace())
    breaking(log)
    always = Always(speed=20.0, stop=False)
    bounds = Bounds(always, list(log.bodies), log.config, log.clock, log.absent)
    for cut in np.split(np.arange(len(log.step)), [1, BROKEN - 1, BROKEN, BROKEN + 1, 150]):
        steps = log.step["step"][cut]
        low, high = np.searchsorted(log.contact["step"], [steps[0], steps[-1] + 1])
        none = np.zeros(0, [("step", "i8")])
        bounds.within(Block(log.step[cut], log.contact[low:high], log.pose[cut], none))
    assert bounds.worst is not None
    by_log = outcomes_of(always, log)
    assert not all(outcome.passed for outcome in by_log.values())
    assert repr(bounds.worst.outcomes(log.status, log)) == repr(by_log)  # NaN, too, is the same


def test_a_check_that_is_none_is_not_made(finished: Finished) -> None:
    log = Falsified(finished.run.cells[0].trace())
    assert list(outcomes_of(Always(energy="none", residual="none"), log)) == [
        *("finite", "penetration", "impulses", "momentum")
    ]


def test_a_log_that_ends_early_is_judged_up_to_its_last_whole_state(finished: Finished) -> None:
    log = Falsified(finished.run.cells[0].trace())
    log.status = "diverged: body low is no longer finite after step 240 (t = 1 s)"
    log.step["kinetic_energy"][-1] = np.nan
    assert all(outcome.passed for outcome in outcomes_of(Always(), log).values())
    log.step["kinetic_energy"][-2] = np.nan
    outcome = outcomes_of(Always(), log)["energy"]
    assert not outcome.passed
    assert outcome.follows


def test_the_work_of_a_torque_is_that_of_the_turn(tmp_path: Path) -> None:
    """A torque spins a ball from 60 to 87.5 rad/s and back: no step wins energy."""
    config = tmp_path / "spun.yaml"
    config.write_text("""\
scene:
  gravity: [0, 0, 0]
  bodies:
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      position: [0, 0, 0]
      angular_velocity: [0, 60, 0]
  forces:
    - {body: ball, from: 0.0, to: 0.5, torque: [0, 0.22, 0]}
    - {body: ball, from: 0.5, to: 1.0, torque: [0, -0.22, 0]}
duration: 1.0
# 240 sums of at most 15.4 J, each rounded by 2^-53, over at least the 7.2 J of the beginning
always: {energy: 6e-14}
""")
    finished = lavendersim.run(config, root=tmp_path)
    assert finished.good
    (cell,) = finished.run.cells
    # 0.22 N m / (0.4 * 1 kg * 0.01 m^2) * 0.5 s, exactly as many steps forth as back
    assert cell.trace().step["kinetic_energy"].max() == pytest.approx(0.5 * 0.004 * 87.5**2)
