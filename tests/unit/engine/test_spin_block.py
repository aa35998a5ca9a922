"""Angular impulses turn bodies by their inverse inertias, and stop turning within their limits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import Drawn, drawn, put_vector, stacked, views
from interpreted import interpreted
from plain_facts import one_row

from lavendersim.engine import spin_block
from lavendersim.engine.solvers.newton.torques import make_accept_torques
from lavendersim.engine.spec import Spec

BOTH = Spec(effects=("friction", "rolling_friction", "rotation", "torsional_friction"))
PLAIN = Spec(effects=("friction", "rotation"))
TORSION, ROLLING = BOTH.without("rolling_friction"), BOTH.without("torsional_friction")
C = 0.02


class Turning:
    """Two bodies in contact, the frame n, t1, t2 as rows, and S of the angular impulses."""

    def __init__(self, spec: Spec, rng: np.random.Generator, fixed: tuple[int, ...] = ()) -> None:
        self.scene: Drawn = drawn(spec, rng, [(0, 1)], fixed=fixed)
        _, velocities, contacts = views(self.scene)
        self.contact, self.va, self.vb = contacts[0], velocities[0], velocities[1]
        self.frame = np.array([[self.contact[f"{n}{a}"] for a in "xyz"] for n in ("n", "t1", "t2")])
        inverse = self.scene.inverse
        self.each = inverse[3:6, 3:6], inverse[9:12, 9:12]
        self.response = self.frame @ sum(self.each) @ self.frame.T
        pair = one_row(torsional_friction=C, rolling_friction=C)
        interpreted(spin_block.make_complete_spin(spec))(self.contact, self.va, self.vb, pair)

    @property
    def spin(self) -> np.ndarray:
        """The relative angular velocity, along n, t1, t2."""
        v = stacked(self.scene.velocities)
        return self.frame @ (v[9:12] - v[3:6])

    @property
    def psi(self) -> np.ndarray:
        return np.array([self.contact.psi_n, self.contact.psi_1, self.contact.psi_2])


def test_responses_are_those_of_the_inverse_inertias(rng) -> None:
    found = Turning(BOTH, rng)
    row, s = found.contact, found.response
    assert row.k_torsion == pytest.approx(s[0, 0], rel=1e-13)
    inverse = [[row.h_11, row.h_12], [row.h_12, row.h_22]]
    np.testing.assert_allclose(inverse @ s[1:, 1:], np.eye(2), atol=1e-13)
    assert row.k_roll == pytest.approx(np.linalg.eigvalsh(s[1:, 1:])[-1], rel=1e-13)
    assert (row.torsional, row.rolling) == (C, C)
    assert not found.psi.any()


def test_a_row_without_a_normal_turns_nothing_and_stays_finite(rng) -> None:
    """As a motor's row of a torque alone, in a scene with torsional friction elsewhere."""
    found = Turning(TORSION, rng)
    put_vector(found.scene.contacts[0], "n", np.zeros(3))
    pair = one_row(torsional_friction=0.0, rolling_friction=0.0)
    interpreted(spin_block.make_complete_spin(TORSION))(found.contact, found.va, found.vb, pair)
    before = stacked(found.scene.velocities)
    solve = interpreted(make_accept_torques(TORSION.including("newton")))
    with np.errstate(all="raise"):
        solve(found.contact, found.va, found.vb)
    assert found.contact.psi_n == 0.0
    np.testing.assert_array_equal(stacked(found.scene.velocities), before)


@pytest.mark.parametrize("fixed", [(), (0,), (1,)])
def test_the_arm_is_the_longer_of_what_moves(fixed: tuple[int, ...], rng) -> None:
    longer = set()
    for _ in range(10):
        row = Turning(BOTH, rng, fixed).contact
        arms = [np.linalg.norm([row[f"r{side}{axis}"] for axis in "xyz"]) for side in "ab"]
        longer.add(arms[0] > arms[1])
        expected = max(arm for k, arm in enumerate(arms) if k not in fixed)
        assert row.arm == pytest.approx(expected, rel=1e-15)
    assert longer == {False, True}


def test_an_angular_impulse_turns_b_forward_and_a_back(rng) -> None:
    found, psi = Turning(BOTH, rng), rng.normal(size=3)
    before = stacked(found.scene.velocities)
    interpreted(spin_block.make_apply_spin(BOTH))(found.contact, found.va, found.vb, *psi)
    change = stacked(found.scene.velocities) - before
    world = found.frame.T @ psi
    np.testing.assert_allclose(change[3:6], -found.each[0] @ world, atol=1e-14)
    np.testing.assert_allclose(change[9:12], found.each[1] @ world, atol=1e-14)
    assert not change[[0, 1, 2, 6, 7, 8]].any()


@pytest.mark.parametrize("spec", [BOTH, TORSION, ROLLING])
def test_a_solve_starts_with_the_impulses_that_contacts_have(spec: Spec, rng) -> None:
    found, psi = Turning(spec, rng), rng.normal(size=3)
    for name, value in zip(("psi_n", "psi_1", "psi_2"), psi, strict=True):
        if name in found.scene.contacts.dtype.names:
            found.contact[name] = value
    kept = psi * [spec is not ROLLING, spec is not TORSION, spec is not TORSION]
    before = found.spin
    interpreted(spin_block.make_apply_start_torques(spec))(found.contact, found.va, found.vb)
    np.testing.assert_allclose(found.spin - before, found.response @ kept, atol=1e-13)


def solved(found: Turning, updates: int) -> list[float]:
    solve = interpreted(spin_block.make_solve_spin(BOTH))
    return [solve(found.contact, found.va, found.vb) for _ in range(updates)]


def residual(found: Turning) -> float:
    return interpreted(spin_block.make_spin_residual(BOTH))(found.contact, found.va, found.vb)


def test_within_its_limits_all_turning_stops_and_momentum_stays(rng) -> None:
    found = Turning(BOTH, rng)
    found.contact.lambda_n = 1e6
    before, momentum = found.spin, angular_momentum(found)
    changes = solved(found, 200)
    assert changes[-1] < 1e-14
    np.testing.assert_allclose(found.spin, 0.0, atol=1e-13)
    np.testing.assert_allclose(found.psi, -np.linalg.solve(found.response, before), atol=1e-12)
    np.testing.assert_allclose(angular_momentum(found), momentum, atol=1e-12)
    assert residual(found) < 1e-12


def angular_momentum(found: Turning) -> np.ndarray:
    whole = found.scene.mass @ stacked(found.scene.velocities)
    return whole[3:6] + whole[9:12]


def test_beyond_them_each_is_at_its_limit_against_the_turning_that_is_left(rng) -> None:
    found = Turning(BOTH, rng)
    found.contact.lambda_n = 1.0
    first = residual(found)
    changes = solved(found, 400)
    spin, psi = found.spin, found.psi
    assert psi[0] == pytest.approx(-C * np.sign(spin[0]), rel=1e-14)
    np.testing.assert_allclose(psi[1:], -C * spin[1:] / np.hypot(*spin[1:]), atol=1e-12)
    assert changes[-1] < 1e-13
    assert residual(found) < 1e-12 < first


def test_changes_and_residuals_are_speeds_at_the_arm(rng) -> None:
    """The first change is the whole turning that stops, so is the residual before it."""
    found = Turning(BOTH, rng)
    found.contact.lambda_n, found.contact.rolling = 1e6, 0.0
    spin, arm = found.spin, found.contact.arm
    assert solved(found, 1)[0] == pytest.approx(abs(spin[0]) * arm, rel=1e-13)
    other = Turning(BOTH, rng)
    other.contact.lambda_n = 1e6
    spin, arm = other.spin, other.contact.arm
    expected = max(abs(spin[0]), np.hypot(*spin[1:])) * arm
    assert residual(other) == pytest.approx(expected, rel=1e-13)


def test_what_is_no_number_is_seen(rng) -> None:
    for name in ("psi_n", "psi_1"):
        found = Turning(BOTH, rng)
        found.contact.lambda_n, found.contact[name] = 1.0, np.nan
        assert np.isnan(residual(found))
        assert np.isnan(solved(found, 1)[0])


@pytest.mark.parametrize("spec", [BOTH, TORSION, ROLLING, PLAIN])
def test_contacts_resist_turning_where_a_coefficient_is_positive(spec: Spec) -> None:
    torsional, rolling = (spec.has(f"{name}_friction") for name in ("torsional", "rolling"))
    assert spin_block.resists_turning(spec) is (torsional or rolling)
    resists = interpreted(spin_block.make_resists_turning(spec))
    for c_t, c_r in ((0.0, 0.0), (C, 0.0), (0.0, C)):
        pair: Any = one_row(torsional_friction=c_t, rolling_friction=c_r)
        assert resists(pair) is bool((torsional and c_t > 0.0) or (rolling and c_r > 0.0))
    if spec is PLAIN:
        assert spin_block.make_solve_spin(spec) is None
        assert spin_block.make_spin_residual(spec) is None
        assert spin_block.make_apply_start_torques(spec) is None
