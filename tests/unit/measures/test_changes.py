"""What events give: energy and momentum of a fall whose gravity, mass and orientation change."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.lib.recfunctions import append_fields

from lavendersim.errors import UsageError
from lavendersim.measures import balance, changes
from lavendersim.measures.contact_sums import summed
from tests.unit.measures.synthetic import GRAVITY, MASS, log_of, scene_of, trace_of

DT = 0.01
PULLS = [-GRAVITY, -GRAVITY, 3.0, 3.0, -1.62, -1.62]  # [m/s^2] in steps 1 to 6
NONE = dict.fromkeys(("scale_mass", "teleport", "velocity", "angular_velocity")) | {
    "contact_cache": "keep",
    "remove": False,
}


def fall(*events: dict[str, Any]) -> Any:
    """A ball that starts at 1 m and falls by the midpoint rule, as gravity changes.

    Its log has what gravity of each step makes of the potential energy of its end.
    """
    changed = [{"at": 2 * DT, "gravity": [0, 0, 3.0]}, {"at": 4 * DT, "gravity": [0, 0, -1.62]}]
    speeds = np.concatenate([[0.0], np.cumsum(PULLS) * DT])
    heights = 1.0 + np.concatenate([[0.0], np.cumsum(0.5 * (speeds[1:] + speeds[:-1])) * DT])
    ball = {"shape": {"kind": "sphere", "radius": 0.1}, "mass": MASS}
    floor = {"shape": {"kind": "sphere", "radius": 0.1}}
    resolved = scene_of({"floor": floor, "ball": ball}) | {"events": [*changed, *events]}
    log = trace_of(list(heights), speeds=list(speeds), resolved=resolved)
    log.pose[:, 1, 2] = heights
    pulls = np.array([PULLS[0], *PULLS])
    log.step["potential_energy"] = -MASS * pulls * heights
    log.absent = {"/contacts": "nothing touches"}
    return log


def test_energy_of_a_fall_is_balanced_over_changes_of_gravity() -> None:
    """Kinetic and potential energy less what the changes gave is what it was, to round-off."""
    log = fall()
    energy = log.step["kinetic_energy"] + log.step["potential_energy"]
    given = np.cumsum(changes.given_by_events(log))
    np.testing.assert_allclose(energy - given, energy[0], rtol=1e-14)
    assert np.count_nonzero(changes.given_by_events(log)) == 2


def test_a_change_before_the_first_step_has_acted_in_the_first_state() -> None:
    log = fall()
    log.resolved["events"] = [{"at": 0.0, "gravity": [0, 0, -GRAVITY]}]
    log.resolved["scene"]["gravity"] = [0, 0, 0]
    np.testing.assert_array_equal(changes.given_by_events(log), 0.0)
    assert changes.gravity(log)[1:, 2].tolist() == [-GRAVITY] * 6


def test_momentum_of_a_fall_is_balanced_over_changes_of_gravity() -> None:
    log = fall()
    assert balance.momentum_imbalance(log, summed(log)).max() < 1e-14
    log.resolved["events"] = []
    assert balance.momentum_imbalance(log, summed(log)).max() > 0.1


def test_the_second_half_of_a_log_knows_what_changed_in_the_first() -> None:
    log = fall()
    whole = changes.gravity(log), changes.given_by_events(log)
    log.step, log.pose = log.step[2:], log.pose[2:]
    np.testing.assert_array_equal(changes.gravity(log), whole[0][2:])
    np.testing.assert_array_equal(changes.given_by_events(log), whole[1][2:])


def test_mass_place_and_gravity_may_change_at_once() -> None:
    """-m g x with all three new, less the same with all three old."""
    put = {"at": 2 * DT, "body": "ball", **NONE, "scale_mass": 1.5, "teleport": [0.0, 0.0, 7.0]}
    log = fall(put)
    before, kinetic = float(log.pose[2, 1, 2]), float(log.step["kinetic_energy"][2])
    old, new = MASS * GRAVITY * before, -1.5 * MASS * 3.0 * 7.0
    given = float(changes.given_by_events(log)[3])
    assert given == pytest.approx(new - old + 0.5 * kinetic, rel=1e-14)


def test_a_new_orientation_gives_no_more_than_the_ratio_of_the_moments() -> None:
    """A box of 1 x 1 x 3 m: moments as 10, 10 and 2; on its end it may have 5 times the energy."""
    box = {"shape": {"kind": "box", "size": [1, 1, 3]}, "mass": 12.0, "inertia": [10, 10, 2]}
    turned = {"at": DT, "body": "box", **NONE, "orientation": [1.0, 1.0, 0.0, 0.0]}
    log = log_of(scene_of({"box": box}) | {"events": [turned]}, np.zeros((3, 1, 3)))
    log.step["kinetic_energy"] = 7.0
    assert changes.given_by_events(log).tolist() == pytest.approx([0.0, 0.0, 28.0])


def test_the_work_of_a_torque_is_that_of_the_turn_from_where_an_event_put_the_body() -> None:
    """Turned by 90 degrees at once, then by 0.02 rad about z under 5 N m: 0.1 J by Cayley."""
    angles = np.array([0.0, 0.02, np.pi / 2 + 0.02])
    quaternions = np.zeros((3, 1, 4))
    quaternions[:, 0, 0], quaternions[:, 0, 3] = np.cos(angles / 2), np.sin(angles / 2)
    ball = {"shape": {"kind": "sphere", "radius": 0.1}, "mass": MASS}
    half = float(np.sqrt(0.5))
    put = {"at": DT, "body": "ball", **NONE, "orientation": [half, 0.0, 0.0, half]}
    force = {"body": "ball", "from": 0.0, "to": 1.0, "force": [0, 0, 0], "torque": [0, 0, 5.0]}
    resolved = scene_of({"ball": ball}, forces=[force]) | {"events": [put]}
    log = log_of(resolved, np.zeros((3, 1, 3)), quaternions)
    turn = 2.0 * np.tan(0.01)
    np.testing.assert_allclose(changes.work_of_forces(log), [0.0, 5 * turn, 5 * turn], rtol=1e-13)


def test_the_work_of_a_torque_is_that_of_the_turns_of_substeps() -> None:
    """Each turns by Cayley's map: four of 0.1 rad are not one of 0.4; of none it is one step's."""
    angles = np.array([0.0, 0.4, 0.8, 0.8])
    quaternions = np.zeros((4, 1, 4))
    quaternions[:, 0, 0], quaternions[:, 0, 3] = np.cos(angles / 2), np.sin(angles / 2)
    ball = {"shape": {"kind": "sphere", "radius": 0.1}, "mass": MASS}
    force = {"body": "ball", "from": 0.0, "to": 1.0, "force": [0, 0, 0], "torque": [0, 0, 5.0]}
    log = log_of(scene_of({"ball": ball}, forces=[force]), np.zeros((4, 1, 3)), quaternions)
    log.step = append_fields(log.step, "substeps", np.array([0, 4, 0, 4]), usemask=False)
    expected = [0.0, 4 * 10 * np.tan(0.05), 10 * np.tan(0.2), 0.0]
    np.testing.assert_allclose(changes.work_of_forces(log), expected, rtol=1e-13, atol=1e-13)


def test_what_takes_one_gravity_says_so_where_it_changes_and_only_there() -> None:
    log = fall()
    with pytest.raises(UsageError, match=r"^creep takes one gravity, and an event changes it from"):
        changes.constant_gravity(log, "creep")
    assert changes.constant_gravity(log, "creep", 5).tolist() == [0.0, 0.0, -1.62]


def test_masses_are_those_of_the_scene_that_is_asked_of() -> None:
    """One body is halved on the way; a second scene of half the mass is asked in between."""
    halved, light = fall(NONE | {"at": 3 * DT, "body": "ball", "scale_mass": 0.5}), fall()
    light.resolved["scene"]["bodies"]["ball"]["mass"] = 0.5 * MASS
    for _ in range(2):
        assert changes.masses(halved).tolist() == [MASS] * 4 + [0.5 * MASS] * 3
        assert changes.masses(light).tolist() == [0.5 * MASS] * 7
    kept = halved.config.scene
    assert changes._movable_masses(kept) == changes._movable_masses(kept) == {"ball": MASS}
