"""One step of accelerated projected gradients, written in numpy: y, its gradient, and the sums."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import drawn, put, views
from interpreted import interpreted
from matrix_solves import projected

from lavendersim.engine.solvers.accelerated_projected_gradient import make_advance, make_begin
from lavendersim.engine.solvers.jacobi import make_apply_changes
from lavendersim.engine.spec import Spec

SPEC = Spec(("friction", "rotation"), solver="accelerated_projected_gradient")
PAIRS, THETA = [(0, 1), (1, 2), (2, 0)], 0.7


def triples(scene: Any, name: str) -> np.ndarray:
    return np.stack([scene.contacts[f"{name}_{axis}"] for axis in "n12"], axis=1)


@pytest.mark.parametrize("beta", [0.0, 0.6])
def test_the_step_is_against_the_gradient_where_it_goes_on(beta: float, rng) -> None:
    """y = x + beta (x - x_before), w(y) of the impulses y, x' = P_K(y - (w(y) + s)/(theta c))."""
    scene = drawn(SPEC, rng, PAIRS)
    bound = rng.uniform(20.0, 40.0, len(PAIRS))
    for row, own in zip(scene.contacts, bound, strict=True):
        put(row, "bound", own)
    _, velocities, contacts = views(scene)
    free = scene.motion - scene.inverse @ scene.jacobian.T @ triples(scene, "lambda").ravel()
    interpreted(make_begin(SPEC))(contacts, len(PAIRS), velocities)
    scene.contacts["shift"] = shift = rng.uniform(0.0, 0.5, len(PAIRS))

    def gradient(impulses: np.ndarray) -> np.ndarray:
        w = scene.jacobian @ (free + scene.inverse @ scene.jacobian.T @ impulses.ravel())
        w = w.reshape(-1, 3)
        return w + np.column_stack([scene.contacts["target"], 0.0 * bound, 0.0 * bound])

    advance = interpreted(make_advance(SPEC))
    apply_changes = interpreted(make_apply_changes(SPEC))
    before, mu = triples(scene, "lambda"), scene.contacts["mu"]
    for contact in contacts:
        advance(contact, velocities, 0.0, 1.0)
    apply_changes(contacts, len(PAIRS), velocities)
    x = triples(scene, "lambda")
    assert abs(x - before).max() > 1e-3
    own = [advance(contact, velocities, beta, THETA) for contact in contacts]
    y, normal = x + beta * (x - before), np.column_stack([shift, 0.0 * shift, 0.0 * shift])
    np.testing.assert_allclose(triples(scene, "base"), y, atol=1e-13)
    np.testing.assert_allclose(triples(scene, "gradient"), gradient(y), atol=1e-12)
    after = projected(y - (gradient(y) + normal) / (THETA * bound)[:, None], mu)
    np.testing.assert_allclose(triples(scene, "lambda"), after, atol=1e-13)
    # What is left of the problem with this shift, and what that is off, squared and by c.
    left = projected(x - (gradient(x) + normal) / bound[:, None], mu) - x
    natural_map = bound * (left**2).sum(axis=1)
    np.testing.assert_allclose([sums.natural_map for sums in own], natural_map, rtol=1e-9)
    defect = (mu * np.linalg.norm(gradient(x)[:, 1:], axis=1) - shift) ** 2 / bound
    np.testing.assert_allclose([sums.shift_defect for sums in own], defect, rtol=1e-9)
    uphill = bound * ((y - after) * (after - x)).sum(axis=1)
    np.testing.assert_allclose([sums.uphill for sums in own], uphill, rtol=1e-7, atol=1e-12)
