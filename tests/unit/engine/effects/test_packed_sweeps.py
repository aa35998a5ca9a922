"""Packed sweeps are decided on by the plan, which says why, and can be switched off."""

from __future__ import annotations

from typing import Any

import pytest
from laboratory import plane, planned, resolved, sphere

from lavendersim.engine.effects.decision import BodyFacts, Facts
from lavendersim.engine.effects.packed_sweeps import FEWEST_BODIES, decide

GRAVITY = (0.0, 0.0, -9.81)


def decided(count: int = FEWEST_BODIES, surface: Any = None, **numerics: Any):
    surface = {"friction": 0.5} if surface is None else surface
    balls = {f"ball_{k}": sphere(0.1, (0.3 * k, 0.0, 0.1), **surface) for k in range(count)}
    cell = resolved(
        {"floor": plane(**surface), **balls}, GRAVITY, **{"solver": "adaptive", **numerics}
    )
    return planned(cell).decisions["packed_sweeps"]


@pytest.mark.parametrize(
    "surface",
    [
        {"friction": 0.5},
        {},
        {"compliance": 1e-6},
        {"torsional_friction": 0.01},
        {"friction": 0.5, "rolling_friction": 0.01},
    ],
    ids=lambda surface: " ".join(surface) or "frictionless",
)
def test_many_bodies_are_swept_packed_whatever_their_surfaces(surface: dict[str, float]) -> None:
    found = decided(surface=surface)
    assert found.on
    assert found.reason == "200 movable bodies have contacts enough to visit eight at a time"


def test_bodies_that_nothing_can_touch_are_not_swept() -> None:
    body = BodyFacts("ball", "sphere", movable=True, spins=False, round=True)
    facts = Facts((body,) * FEWEST_BODIES, (), GRAVITY, 0.0, 0.2, True)
    assert decide(facts) == (False, "nothing can touch")


@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        ({"count": 199}, "199 movable bodies, fewer than 200"),
        ({"solver": "coloured_gauss_seidel"}, "the solver is coloured_gauss_seidel"),
        ({"friction_cone": "pyramid"}, "the friction cone is pyramid"),
        ({"order": "forward"}, "the order of sweeps is forward"),
        ({"over_relaxation": 1.3}, "over_relaxation is 1.3"),
    ],
    ids=str,
)
def test_other_scenes_are_swept_over_the_records(scene: Any, reason: str) -> None:
    found = decided(**scene)
    assert not found.on
    assert found.reason == reason
