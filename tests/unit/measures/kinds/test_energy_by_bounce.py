"""Energy of a bouncing ball, from apex to apex: (h_k + 0)/h_0 - 1 where the plane is its zero."""

from __future__ import annotations

import numpy as np
import pytest
from synthetic import trace_of

from lavendersim.measures import evaluate
from lavendersim.measures.specs.energy import EnergyAfterBounces, EnergyByBounce

# drops from 1 m, rises to 0.64 m, then to 0.25 m; the run ends on the way up
HEIGHTS = [1.0, 0.5, 0.0, 0.5, 0.64, 0.5, 0.0, 0.2, 0.25, 0.2, 0.0, 0.1]
TOUCHING = [(2, 3.0, 0.0), (6, 2.0, 0.0), (10, 1.0, 0.0)]


def by_bounce(bounces: int, touching=TOUCHING) -> np.ndarray:
    spec = EnergyByBounce(kind="energy_by_bounce", body="ball", above="floor", bounces=bounces)
    return evaluate(spec, trace_of(HEIGHTS, touching))


def test_each_apex_has_its_share_of_the_first_energy() -> None:
    assert by_bounce(2) == pytest.approx([-0.36, -0.75], abs=1e-15)


def test_an_apex_the_run_does_not_reach_is_unknown() -> None:
    drift = by_bounce(4)
    assert drift[:2] == pytest.approx([-0.36, -0.75], abs=1e-15)
    assert np.isnan(drift[2:]).all()


def test_contacts_of_neighbouring_steps_are_one_bounce() -> None:
    touching = [(2, 3.0, 0.0), (3, 1.0, 0.0), (6, 2.0, 0.0), (10, 1.0, 0.0)]
    assert by_bounce(2, touching) == pytest.approx([-0.36, -0.75], abs=1e-15)
    grazed = [(1, 0.0, 0.0), *TOUCHING]  # a contact that pushes nothing
    assert by_bounce(2, grazed) == pytest.approx([-0.36, -0.75], abs=1e-15)


def test_kinetic_energy_counts_and_the_last_is_the_number_asked_for() -> None:
    log = trace_of(HEIGHTS, TOUCHING)
    log.step["kinetic_energy"][8] = 0.05 * 2.0 * 9.81  # as much as 0.05 m of height
    spec = EnergyAfterBounces(kind="energy_after_bounces", body="ball", above="floor", bounces=2)
    assert evaluate(spec, log) == pytest.approx(0.3 - 1.0, abs=1e-15)


def test_a_run_that_pushes_nothing_has_no_apex() -> None:
    assert np.isnan(by_bounce(2, [])).all()
    assert np.isnan(by_bounce(2, [(2, 0.0, 0.0)])).all()
