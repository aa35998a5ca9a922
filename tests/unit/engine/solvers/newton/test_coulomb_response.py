"""Impulses answer velocities by Coulomb's law, the normal's by itself; E' is their derivative."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted
from test_response import FRICTIONAL, any_contact, asked_for

from lavendersim.engine.solvers.newton import coulomb_response
from lavendersim.engine.solvers.newton.envelope import OF_A, SCALED

impulse_of = interpreted(coulomb_response.make_coulomb_impulse(FRICTIONAL))
stiffness_of = interpreted(coulomb_response.make_coulomb_stiffness(FRICTIONAL))


def matrix(contact) -> np.ndarray:
    """Return E' of a contact."""
    h = stiffness_of(contact)
    return np.array([[h.nn, 0.0, 0.0], [h.n1, h.t11, h.t12], [h.n2, h.t12, h.t22]])


def test_the_normal_is_signorini_and_the_tangents_are_in_the_disc_that_it_allows(rng) -> None:
    """Of what x = s lambda^k - e w asks for: its normal where it pushes, and the nearest of the
    disc of radius mu lambda_n, which is x itself within it, else on the rim towards x.
    """
    kinds = set()
    for contact in any_contact(rng):
        n, one, two = impulse_of(contact, 0.7)
        x, _ = asked_for(contact, 0.7)
        assert n == pytest.approx(max(x[0], 0.0), abs=1e-15)
        most, asked = contact.mu * n, np.hypot(*x[1:])
        slides = asked > most
        expected = x[1:] * (most / asked) if slides else x[1:]
        np.testing.assert_allclose((one, two), expected, atol=1e-15)
        kinds.add((n > 0.0, bool(slides)))
    assert kinds == {(False, True), (True, False), (True, True)}


def test_stiffness_is_what_impulses_lose_by_velocities(rng) -> None:
    small = 1e-6  # central differences of a smooth function: its square, and round-off over it
    for contact in any_contact(rng):
        for axis in "n12":
            setattr(contact, f"step_{axis}", 0.0)
        found = matrix(contact)
        for column, axis in enumerate("n12"):
            setattr(contact, f"step_{axis}", small)
            change = np.subtract(impulse_of(contact, -1.0), impulse_of(contact, 1.0))
            setattr(contact, f"step_{axis}", 0.0)
            np.testing.assert_allclose(found[:, column], change / (2 * small), atol=1e-8)


def test_rows_are_scaled_by_stiffness_and_by_its_transpose(rng) -> None:
    scale = interpreted(coulomb_response.make_scale_by_coulomb(FRICTIONAL))
    scale_transposed = interpreted(coulomb_response.make_scale_transposed(FRICTIONAL))
    for contact in any_contact(rng):
        rows, e = rng.normal(size=(9, 6)), matrix(contact)
        own = rows[OF_A : OF_A + 3].copy()
        scale(rows, OF_A, stiffness_of(contact))
        np.testing.assert_allclose(rows[SCALED : SCALED + 3], e @ own, atol=1e-13)
        scale_transposed(rows, OF_A, stiffness_of(contact))
        np.testing.assert_allclose(rows[SCALED : SCALED + 3], e.T @ own, atol=1e-13)
