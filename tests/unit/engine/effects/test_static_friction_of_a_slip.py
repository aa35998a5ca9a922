"""The coefficient of a contact is that of the slip with which the step begins, in any frame."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import random_frame
from interpreted import interpreted, records
from plain_facts import one_row, vector_fields

from lavendersim.engine.effects.static_friction import (
    RESOLVED,
    make_note_middle,
    make_prepare,
    make_start_step,
)
from lavendersim.engine.spec import Spec

KINETIC, STATIC, STRIBECK = 0.3, 0.9, 1.7


@pytest.mark.parametrize("patch", [False, True])
@pytest.mark.parametrize("belts", [False, True])
def test_mu_falls_with_the_square_of_the_slip_of_both_points(belts: bool, patch: bool, rng) -> None:
    """mu_k + (mu_s - mu_k)/(1 + |s|^2/v^2), s = v_b + w_b x r_b - v_a - w_a x r_a in the plane.

    A point of a patch has e (n . (w_b - w_a)) more, of its lever e.
    """
    beside = ("contact_patch",) * patch + ("surface_velocity",) * belts
    spec = Spec(("static_friction", *beside))
    kernel = interpreted(make_prepare(spec))
    for _ in range(10):
        speed, spin, arm = (dict(zip("ab", rng.normal(size=(2, 3)), strict=True)) for _ in range(3))
        normal, one, two = random_frame(rng)
        belt, lever = rng.normal(size=2), rng.normal(size=3)
        contact = one_row(
            mu=0.0,
            surface_1=belt[0],
            surface_2=belt[1],
            **vector_fields("ra", arm["a"]),
            **vector_fields("rb", arm["b"]),
            **vector_fields("n", normal),
            **vector_fields("patch_", lever),
            **vector_fields("t1", one),
            **vector_fields("t2", two),
        )
        rows = [
            one_row(**vector_fields("start_v", speed[k]), **vector_fields("start_w", spin[k]))
            for k in "ab"
        ]
        pair = one_row(friction=KINETIC, static_friction=STATIC, stribeck_velocity=STRIBECK)
        kernel(contact, *rows, pair, None)
        point = {k: speed[k] + np.cross(spin[k], arm[k]) for k in "ab"}
        apart = point["b"] - point["a"]
        if patch:
            apart = apart + lever * (normal @ (spin["b"] - spin["a"]))
        slip = np.array([one, two]) @ apart + (belt if belts else 0.0)
        expected = KINETIC + (STATIC - KINETIC) / (1.0 + slip @ slip / STRIBECK**2)
        assert contact.mu == pytest.approx(expected, rel=1e-14)


def slipping(start: float, mean: float, push: float = 0.0) -> float:
    """Return mu of a row whose point slips so fast as the step begins, and in its mean [m/s].

    push: k_t lambda_n, what friction of 1 changes of the slip in the step [m/s].
    """
    nothing, x = np.zeros(3), np.array([1.0, 0.0, 0.0])
    vectors = {"ra": nothing, "rb": nothing, "n": np.array([0.0, 0.0, 1.0])}
    vectors |= {"t1": x, "t2": np.array([0.0, 1.0, 0.0])}
    contact = one_row(mu=0.0, kept_n=0.5 * push, k_t=2.0, **_fields(vectors))
    still = dict.fromkeys(("start_v", "start_w", "mean_v", "mean_w"), nothing)
    moving = still | {"start_v": start * x, "mean_v": mean * x}
    pair = one_row(friction=KINETIC, static_friction=STATIC, stribeck_velocity=STRIBECK)
    kernel = interpreted(make_prepare(Spec(("contact_midpoint", "static_friction"))))
    kernel(contact, one_row(**_fields(still)), one_row(**_fields(moving)), pair, None)
    return contact.mu


def _fields(vectors: dict[str, np.ndarray]) -> dict[str, float]:
    return {k: v for name, one in vectors.items() for k, v in vector_fields(name, one).items()}


def curve(slip: float) -> float:
    return KINETIC + (STATIC - KINETIC) / (1.0 + (slip / STRIBECK) ** 2)


def test_at_the_middle_of_the_step_it_is_that_of_the_mean_slip_as_far_as_a_step_resolves() -> None:
    """Up to a quarter of Stribeck's velocity from the slip of the start, towards the mean."""
    most = RESOLVED * STRIBECK
    for start, mean in ((2.0, 2.0), (2.0, 2.0 - 0.9 * most), (0.0, 0.9 * most), (0.1, -0.1)):
        assert slipping(start, mean) == pytest.approx(curve(mean), rel=1e-14)
    for start, mean, ends in ((2.0, 0.0, 2.0 - most), (2.0, 9.0, 2.0 + most), (0.0, 9.0, most)):
        assert slipping(start, mean) == pytest.approx(curve(ends), rel=1e-14)
    # Friction that falls by STATIC - KINETIC changes the slip by half of that velocity, or by more.
    push, mean = 0.5 * STRIBECK / (STATIC - KINETIC), 2.0 - 0.9 * most
    assert slipping(2.0, mean, 0.999 * push) == pytest.approx(curve(mean), rel=1e-14)
    assert slipping(2.0, mean, 1.001 * push) == pytest.approx(curve(2.0), rel=1e-14)


def test_means_are_of_both_ends_in_a_pass_and_of_the_start_else(rng) -> None:
    spec = Spec(("contact_midpoint", "static_friction"))
    start, end, lead = rng.normal(size=(3, 6))
    names = ("v", "w", "start_v", "start_w", "mean_v", "mean_w")
    row = records(np.zeros(1, [(f"{name}{x}", "f8") for name in names for x in "xyz"]))
    first = records(row.array.copy())

    def put(rows: object, vector: np.ndarray) -> None:
        for name, value in zip([f"{k}{x}" for k in "vw" for x in "xyz"], vector, strict=True):
            rows.array[name] = value  # type: ignore[attr-defined]

    def mean() -> list[float]:
        return [row[0][f"mean_{k}{x}"] for k in "vw" for x in "xyz"]

    put(row, start)
    put(first, lead)
    interpreted(make_start_step(spec))(row, row)
    assert mean() == start.tolist()
    put(row, end)
    interpreted(make_note_middle(spec))(row, row, first, True, None)
    np.testing.assert_allclose(mean(), 0.5 * (lead + end), rtol=1e-15)
    interpreted(make_note_middle(spec))(row, row, first, False, None)
    assert mean() == start.tolist()
