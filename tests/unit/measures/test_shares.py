"""What effects declare of the balances of energy and momentum is counted there."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.lib.recfunctions as recfunctions
import pytest

from lavendersim.measures import balance, shares
from lavendersim.measures.contact_sums import summed
from tests.unit.measures.synthetic import scene_of, trace_of

MASS = 2.0


def drawn(axis: str) -> Any:
    """A ball that a spring on a hook gives 0.5 N s in each of four steps, without gravity."""
    ball = {"shape": {"kind": "sphere", "radius": 0.1}, "mass": MASS}
    hook = {"shape": {"kind": "sphere", "radius": 0.1}}
    log = trace_of([1.0] * 5, resolved=scene_of({"floor": hook, "ball": ball}, gravity=[0, 0, 0]))
    impulse = np.array([0.0, 0.5, 0.5, 0.5, 0.5])
    momentum = np.cumsum(impulse)
    log.step[f"momentum_{axis}"] = momentum
    log.step["kinetic_energy"] = momentum**2 / (2.0 * MASS)
    names = [f"spring_impulse_{one}" for one in "xyz"]
    columns = [impulse if one == axis else np.zeros(5) for one in "xyz"]
    log.step = recfunctions.append_fields(log.step, names, columns, usemask=False)
    log.absent = {"/contacts": "nothing can touch"}
    return log


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_the_impulse_of_a_spring_on_what_does_not_move_is_a_cause_of_momentum(axis: str) -> None:
    log = drawn(axis)
    np.testing.assert_array_equal(balance.momentum_imbalance(log, summed(log)), 0.0)
    log.step[f"spring_impulse_{axis}"] = 0.0
    # Nothing else explains 0.5 N s; carried before and after: 0 and 0.5 kg m/s at first.
    assert balance.momentum_imbalance(log, summed(log))[1] == 1.0


def test_a_spring_at_a_contact_stores_what_the_compliance_of_its_pair_says() -> None:
    """d^2 / (2 c) of the pair in the first state, before any step has measured it."""
    compliance, depth = 4e-6, 1e-3
    partner = {"surface": "alike", "compliance": compliance}
    surface = {"name": "alike", "partners": [partner], "compliance": 1e-7}
    shape = {"kind": "sphere", "radius": 0.1}
    floor, ball = {"shape": shape, "surface": surface}, {"shape": shape, "mass": MASS}
    resolved = scene_of({"floor": floor, "ball": ball | {"surface": surface}})
    log = trace_of([1.0] * 3, resolved=resolved)
    log.step = recfunctions.append_fields(log.step, "contact_energy", np.zeros(3), usemask=False)
    names = ("step", "body_a", "body_b", "feature", "separation")
    kinds = ("i8", "i8", "i8", "i8", "f8")
    log.contact = np.array([(1, 0, 1, 0, -depth)], dtype=list(zip(names, kinds, strict=True)))
    log.absent = {}
    stored = shares.stored(log)
    assert stored[0] == pytest.approx(0.5 * depth**2 / compliance, rel=1e-15)
