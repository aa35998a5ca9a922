"""A force gives F dt/m to a velocity and a torque I^-1 T dt to a spin, in world axes."""

from __future__ import annotations

from types import SimpleNamespace

import convex
import numpy as np
import pytest
from interpreted import interpreted
from plain_facts import body_facts, facts, matrix_fields, one_row, vector_fields

from lavendersim.engine.effects.external_force import EFFECT, make, make_pushes
from lavendersim.engine.spec import Spec

INERTIA, MASS, DT = np.array([0.2, 0.5, 0.4]), 4.0, 0.01


@pytest.mark.parametrize("turns", [False, True])
def test_force_and_torque_give_their_impulses(turns: bool, rng) -> None:
    matrix, force, torque = convex.random_rotation(rng), *rng.normal(size=(2, 3))
    body = one_row(
        inv_m=1.0 / MASS, inv_ix=5.0, inv_iy=2.0, inv_iz=2.5, **matrix_fields(matrix),
        **vector_fields("f", force), **vector_fields("t", torque),
    )  # fmt: skip
    velocity = one_row(**vector_fields("v", (1.0, 2.0, 3.0)), **vector_fields("w", (4.0, 5.0, 6.0)))
    kernel = interpreted(make(Spec(("rotation",) if turns else ())))
    kernel(body, velocity, one_row(dt=DT))
    found = np.array([[velocity[f"{v}{axis}"] for axis in "xyz"] for v in "vw"])
    spin = np.array([4.0, 5.0, 6.0])
    if turns:
        spin = spin + np.linalg.solve(matrix @ np.diag(INERTIA) @ matrix.T, torque) * DT
    np.testing.assert_allclose(found, [[1.0, 2.0, 3.0] + force / MASS * DT, spin], atol=1e-14)


@pytest.mark.parametrize("own", ["", "fx", "fy", "fz", "tx", "ty", "tz"])
def test_a_body_is_pushed_where_any_part_of_force_or_torque_is_not_zero(own: str) -> None:
    fields = dict.fromkeys(("fx", "fy", "fz", "tx", "ty", "tz"), 0.0)
    body = one_row(**fields | ({own: -1e-300} if own else {}))
    assert bool(interpreted(make_pushes(Spec()))(body)) == bool(own)


def test_it_is_on_where_a_movable_body_is_pushed_at_its_centre_by_what_is_constant() -> None:
    def pushed(name: str, constant: bool = True):
        forces = [SimpleNamespace(body=name, constant_at_centre=constant)]
        bodies = body_facts("box"), body_facts("wall", movable=False)
        return EFFECT.decide(facts(*bodies, scene=SimpleNamespace(forces=forces)))

    assert pushed("box").on
    assert "box" in pushed("box").reason
    assert not pushed("wall").on
    assert not pushed("box", constant=False).on
    assert not EFFECT.decide(facts(body_facts("box"))).on
