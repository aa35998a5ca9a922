"""The coefficient of a contact is that of the slip with which the step begins, in any frame."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import random_frame
from interpreted import interpreted
from plain_facts import one_row, vector_fields

from lavendersim.engine.effects.static_friction import make_prepare
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
