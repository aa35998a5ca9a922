"""Supernodes are decided on by the plan, which says why, and by a config that asks for them."""

from __future__ import annotations

from typing import Any

import pytest
from laboratory import box, plane, planned, resolved, sphere

from lavendersim.engine.effects.decision import Decision
from lavendersim.engine.effects.supernodes import FEWEST_BODIES

GRAVITY = (0.0, 0.0, -9.81)


def decided(
    count: int = FEWEST_BODIES, shape: Any = box, first: Any = None, **numerics: Any
) -> Decision:
    surface = {"friction": 0.5}
    size = (0.1, 0.1, 0.1) if shape is box else 0.05
    each = {f"body_{k}": shape(size, (0.2 * k, 0.0, 0.05), **surface) for k in range(count)}
    if first is not None:
        each["body_0"] = first(0.05, (0.0, 0.0, 0.05), **surface)
    cell = resolved(
        {"floor": plane(**surface), **each}, GRAVITY, **{"solver": "adaptive", **numerics}
    )
    return planned(cell).decisions["supernodes"]


def test_many_boxes_have_them() -> None:
    found = decided()
    assert found.on
    assert found.reason == "the factor of 200 bodies may fill less in another order"


@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        ({"count": FEWEST_BODIES - 1}, "199 movable bodies, fewer than 200"),
        ({"shape": sphere}, "heaps of bodies that touch in single points are left to sweeps"),
        ({"first": sphere}, "heaps of bodies that touch in single points are left to sweeps"),
        ({"solver": "jacobi"}, "no solve is finished by Newton's method"),
        ({"friction_cone": "pyramid"}, "no solve is finished by Newton's method"),
    ],
)
def test_others_do_not_and_the_plan_says_why(scene: dict[str, Any], reason: str) -> None:
    assert decided(**scene) == (False, reason)
