"""What effects declare of the balances of energy and momentum is counted there."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.lib.recfunctions as recfunctions
import pytest

from lavendersim.measures import balance
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
