"""A contact's push from one pass to the next: the same vector, in whatever tangents."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import random_frame
from interpreted import interpreted, records

from lavendersim.engine.midpoint_impulses import make_go_on, make_impulse_of
from lavendersim.engine.record_layout import contact_dtype
from lavendersim.engine.spec import Spec

FRICTION = Spec(("contact_midpoint", "friction", "rotation"), ("sphere_plane",))
TORQUES = FRICTION.including("torsional_friction", "rolling_friction")
SMOOTH = Spec(("contact_midpoint", "rotation"), ("sphere_plane",))


def contact_in(spec: Spec, frame: np.ndarray) -> Any:
    """frame: normal and tangents, one a row."""
    rows = np.zeros(1, contact_dtype(spec))
    for name, direction in zip(("n", "t1", "t2"), frame, strict=True):
        for axis, number in zip("xyz", direction, strict=True):
            if f"{name}{axis}" in rows.dtype.names:
                rows[f"{name}{axis}"] = number
    return rows[0]


def tangential(row: Any, name: str) -> np.ndarray:
    one, two = (np.array([row[f"t{k}{axis}"] for axis in "xyz"]) for k in (1, 2))
    return row[f"{name}_1"] * one + row[f"{name}_2"] * two


def passed_on(spec: Spec, before: Any, after: Any) -> None:
    impulse = interpreted(make_impulse_of(spec))(records(before.reshape(1))[0])
    interpreted(make_go_on(spec))(records(after.reshape(1))[0], impulse)


@pytest.mark.parametrize("push", [2.0, 0.0])
def test_forces_and_torques_are_those_of_the_pass_before(
    rng: np.random.Generator, push: float
) -> None:
    """About the same normal the vectors are equal to round-off; no torque without a push."""
    frame, angle = random_frame(rng), 0.7
    c, s = np.cos(angle), np.sin(angle)
    turned = np.array([frame[0], c * frame[1] + s * frame[2], c * frame[2] - s * frame[1]])
    before, after = contact_in(TORQUES, frame), contact_in(TORQUES, turned)
    before["lambda_n"] = push
    for name in ("lambda_1", "lambda_2", "psi_n", "psi_1", "psi_2"):
        before[name] = rng.normal()
    passed_on(TORQUES, before, after)
    assert after["lambda_n"] == push
    np.testing.assert_allclose(
        tangential(after, "lambda"), tangential(before, "lambda"), atol=1e-15
    )
    expected = tangential(before, "psi") if push > 0.0 else np.zeros(3)
    np.testing.assert_allclose(tangential(after, "psi"), expected, atol=1e-15)
    assert after["psi_n"] == (before["psi_n"] if push > 0.0 else 0.0)


def test_what_a_turned_normal_leaves_is_the_projection(rng: np.random.Generator) -> None:
    before, after = (contact_in(FRICTION, random_frame(rng)) for _ in range(2))
    before["lambda_1"], before["lambda_2"] = 0.3, -0.4
    passed_on(FRICTION, before, after)
    normal = np.array([after[f"n{axis}"] for axis in "xyz"])
    old = tangential(before, "lambda")
    expected = old - normal * (normal @ old)
    np.testing.assert_allclose(tangential(after, "lambda"), expected, atol=1e-15)


def test_what_is_smooth_pushes_along_its_normal_alone(rng: np.random.Generator) -> None:
    before, after = (contact_in(SMOOTH, random_frame(rng)) for _ in range(2))
    before["lambda_n"] = 3.0
    passed_on(SMOOTH, before, after)
    assert after["lambda_n"] == 3.0
