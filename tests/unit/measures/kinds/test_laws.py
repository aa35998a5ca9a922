"""Balance and conservation on logs whose errors are put there by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.lib.recfunctions as recfunctions
import pytest
from synthetic import GRAVITY, MASS, contacts, log_of, scene_of, trace_of

from lavendersim.measures import evaluate
from lavendersim.measures.specs import laws as specs

WEIGHT = MASS * GRAVITY / 100.0  # impulse of the ball's weight in a step of 10 ms [N s]
FORCE = specs.ForceError(kind="force_error", last=0.05)
FLOOR = {"shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}}
CUBE = {"shape": {"kind": "box", "size": [0.2, 0.2, 0.2]}, "mass": MASS}


def resting(errors: dict[int, float]) -> Any:
    """A ball that rests for 20 steps; in some steps its force is wrong by a share."""
    touching = [(step, WEIGHT * (1.0 + errors.get(step, 0.0)), 0.0) for step in range(1, 21)]
    return trace_of([0.0] * 21, touching)


def test_the_worst_step_of_the_window_counts() -> None:
    assert evaluate(FORCE, resting({})) < 4e-16
    assert evaluate(FORCE, resting({3: 0.5})) < 4e-16  # before the window
    assert evaluate(FORCE, resting({17: -0.25, 19: 0.125})) == pytest.approx(0.25, rel=1e-14)


def test_a_step_without_contact_lacks_the_whole_weight() -> None:
    log = resting({})
    log.contact = log.contact[log.contact["step"] != 18]
    assert evaluate(FORCE, log) == 1.0


def test_a_force_on_the_first_body_of_a_contact_has_the_other_sign() -> None:
    log = resting({})
    log.contact["body_a"], log.contact["body_b"], log.contact["nz"] = 1, 0, -1.0
    assert evaluate(FORCE, log) < 4e-16


def with_friction(rows: Any, t1: Any, impulse_1: Any, impulse_2: Any) -> Any:
    added = {"impulse_t1": impulse_1, "impulse_t2": impulse_2}
    added |= {f"t1{axis}": value for axis, value in zip("xyz", t1, strict=True)}
    columns = [np.broadcast_to(np.asarray(value, float), len(rows)) for value in added.values()]
    return recfunctions.append_fields(rows, list(added), columns, usemask=False)


@pytest.mark.parametrize("first", [True, False])
def test_friction_at_a_wall_carries_weight(first: bool) -> None:
    # n = x, t1 = z, t2 = n x t1 = -y, or t1 = y, t2 = z
    log = resting({})
    log.contact["nx"], log.contact["nz"] = 1.0, 0.0
    tangent = (0.0, 0.0, 1.0) if first else (0.0, 1.0, 0.0)
    carried = (WEIGHT, 0.0) if first else (0.0, WEIGHT)
    log.contact = with_friction(log.contact, tangent, *carried)
    assert evaluate(FORCE, log) < 4e-16


def stack() -> Any:
    """Two cubes on a floor: the lower carries both, from below; 10 steps."""
    scene = scene_of({"floor": FLOOR, "lower": CUBE, "upper": CUBE})
    log = log_of(scene, np.zeros((11, 3, 3)))
    rows = contacts([(step, WEIGHT, 0.0) for step in range(1, 11) for _ in range(2)])
    rows["body_a"] = [0, 1] * 10
    rows["body_b"] = [1, 2] * 10
    rows["impulse_n"][::2] *= 2.0
    log.contact = rows
    return log


def test_contacts_between_movable_bodies_cancel_in_the_sum() -> None:
    log = stack()
    assert evaluate(FORCE, log) < 4e-16
    log.contact["impulse_n"][1::2] *= 3.0  # between the cubes: no concern of the scene's weight
    assert evaluate(FORCE, log) < 4e-16


def test_of_one_body_every_contact_counts() -> None:
    spec = FORCE.model_copy(update={"body": "lower"})
    log = stack()
    assert evaluate(spec, log) < 4e-16  # two weights up, one down
    log.contact["impulse_n"][1::2] *= 1.5
    assert evaluate(spec, log) == pytest.approx(0.5, rel=1e-14)


def test_without_gravity_or_window_there_is_no_force_error() -> None:
    log = resting({})
    assert math.isnan(evaluate(FORCE.model_copy(update={"last": 1.0}), log))
    log.resolved["scene"]["gravity"] = [0.0, 0.0, 0.0]
    assert math.isnan(evaluate(FORCE, log))


def falling(energy: list[float]) -> Any:
    """Clearances of a ball with these energies above rest on the floor [J], at rest."""
    return trace_of([one / (MASS * GRAVITY) for one in energy], speeds=[0.0] * len(energy))


def test_energy_is_counted_from_rest_on_the_plane() -> None:
    log = falling([10.0, 9.5, 10.2])
    drift = specs.EnergyDrift(kind="energy_drift", body="ball", above="floor")
    gain = specs.EnergyGain(kind="energy_gain", body="ball", above="floor")
    assert evaluate(drift, log) == pytest.approx(0.05, rel=1e-13)
    assert evaluate(gain, log) == pytest.approx(0.02, rel=1e-12)


def test_without_a_plane_energy_is_counted_as_it_was_logged() -> None:
    log = trace_of([0.0, 0.0], speeds=[2.0, 2.5])
    log.step["potential_energy"] = 0.0
    gain = evaluate(specs.EnergyGain(kind="energy_gain"), log)
    assert gain == pytest.approx(2.5**2 / 2.0**2 - 1.0, rel=1e-14)
    log.step["kinetic_energy"] = 0.0
    assert math.isnan(evaluate(specs.EnergyDrift(kind="energy_drift"), log))


def test_a_loss_is_drift_but_no_gain() -> None:
    log = falling([10.0, 9.0, 8.0])
    spec = {"body": "ball", "above": "floor"}
    assert evaluate(specs.EnergyGain(kind="energy_gain", **spec), log) == 0.0
    assert evaluate(specs.EnergyDrift(kind="energy_drift", **spec), log) == pytest.approx(0.2)


def test_angular_momentum_is_compared_as_a_vector() -> None:
    log = trace_of([0.0] * 3)
    turning = np.array([[0.0, 3.0, 4.0], [0.0, 4.0, 3.0], [5.0, 0.0, 0.0]])
    names = [f"angular_momentum_{axis}" for axis in "xyz"]
    log.step = recfunctions.append_fields(log.step, names, list(turning.T), usemask=False)
    spec = specs.AngularMomentumDrift(kind="angular_momentum_drift")
    # all three are 5 long; the last is at a right angle to the first
    assert evaluate(spec, log) == pytest.approx(math.sqrt(2.0), rel=1e-15)
    log.step[names[1]], log.step[names[2]], log.step[names[0]] = 0.0, 0.0, 0.0
    assert math.isnan(evaluate(spec, log))


def test_steps_that_did_not_converge_are_unknown_where_no_tolerance_is_specified() -> None:
    spec = specs.NotConvergedSteps(kind="not_converged_steps")
    log = trace_of([0.0] * 4)
    assert math.isnan(evaluate(spec, log))
    log.step = recfunctions.append_fields(log.step, "not_converged", [0, 1, 0, 1], usemask=False)
    assert evaluate(spec, log) == 2.0


def test_a_violation_is_the_worst_of_the_steps_after_a_time() -> None:
    log = trace_of([0.0] * 5)  # steps of 10 ms
    parts = {"signorini": [0, 9, 3, 1, 2], "dissipation": [0, 0, 0, 7, 1]}
    log.step["residual"] = [0.0, 0.5, 0.0, 0.25, 0.0]
    values = [np.array(column, float) for column in parts.values()]
    log.step = recfunctions.append_fields(log.step, list(parts), values, usemask=False)

    def worst(part: Any, after: float = 0.0) -> Any:
        return evaluate(specs.LawViolation(kind="law_violation", part=part, after=after), log)

    assert worst("natural_map") == 0.5
    assert worst("natural_map", 0.02) == 0.25
    assert (worst("signorini"), worst("signorini", 0.01)) == (9.0, 3.0)
    assert worst("dissipation") == 7.0
    assert math.isnan(worst("cone"))  # this log has none
    assert math.isnan(worst("signorini", 0.04))  # no step ends later
