"""Packed sweeps are decided on by the plan, which says why, and can be switched off."""

from __future__ import annotations

from typing import Any

import pytest
from laboratory import plane, planned, resolved, sphere

from lavendersim.engine.effects.packed_sweeps import FEWEST_BODIES

GRAVITY = (0.0, 0.0, -9.81)


def decided(count: int = FEWEST_BODIES, surface: Any = None, **numerics: Any):
    surface = {"friction": 0.5} if surface is None else surface
    balls = {f"ball_{k}": sphere(0.1, (0.3 * k, 0.0, 0.1), **surface) for k in range(count)}
    cell = resolved(
        {"floor": plane(**surface), **balls}, GRAVITY, **{"solver": "adaptive", **numerics}
    )
    return planned(cell).decisions["packed_sweeps"]


def test_many_bodies_with_friction_are_swept_packed() -> None:
    found = decided()
    assert found.on
    assert found.reason == "200 movable bodies have contacts enough to visit eight at a time"


@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        ({"count": 199}, "199 movable bodies, fewer than 200"),
        ({"solver": "coloured_gauss_seidel"}, "the solver is coloured_gauss_seidel"),
        ({"friction_cone": "pyramid"}, "the friction cone is pyramid"),
        ({"order": "forward"}, "the order of sweeps is forward"),
        ({"over_relaxation": 1.3}, "over_relaxation is 1.3"),
        ({"surface": {}}, "no contact has friction"),
        (
            {"surface": {"friction": 0.5, "rolling_friction": 0.01}},
            "contacts of floor and ball_0 resist turning",
        ),
    ],
    ids=str,
)
def test_other_scenes_are_swept_over_the_records(scene: Any, reason: str) -> None:
    found = decided(**scene)
    assert not found.on
    assert found.reason == reason
