"""Points can be overlooked where a step has parts and bodies touch at several points."""

from __future__ import annotations

from typing import Any

import pytest
from laboratory import body, box, plane, planned, resolved, sphere

from lavendersim.scene.plan import Plan

IN_ORDER = {"impacts": "in_order", "integrator": "midpoint_contact"}
CAN = {"kind": "cylinder", "radius": 0.05, "length": 0.1}


def plan(shapes: dict[str, Any], **numerics: Any) -> Plan:
    bodies = {"floor": plane(friction=0.5), **shapes}
    return planned(resolved(bodies, (0.0, 0.0, -9.81), **(IN_ORDER | numerics)))


@pytest.mark.parametrize("shape", [box((0.2, 0.2, 0.2), (0, 0, 0.1)), body(CAN, (0, 0, 0.05))])
def test_what_touches_at_several_points_has_it_with_its_reason(shape) -> None:
    decision = plan({"thing": shape}).decisions["overlooked_points"]
    assert decision == (True, "floor and thing may touch at several points")
    off = plan({"thing": shape}, impacts="at_surface").decisions["overlooked_points"]
    assert off == (False, "steps have one part: impacts are at_surface")


def test_spheres_have_single_points_whatever_they_touch() -> None:
    balls = {f"ball_{k}": sphere(0.1, (0.3 * k, 0.0, 0.1), friction=0.5) for k in range(3)}
    step = box((1.0, 1.0, 0.1), (2.0, 0.0, 0.05), fixed=True, friction=0.5)
    for shapes in (balls, balls | {"step": step}):
        found = plan(shapes)
        assert found.decisions["overlooked_points"] == (False, "spheres touch at single points")
        assert "impact_order" in found.spec.effects


def test_spheres_of_a_compound_are_several_points() -> None:
    parts = [
        {"shape": {"kind": "sphere", "radius": 0.1}, "position": [x, 0, 0]} for x in (-0.2, 0.2)
    ]
    dumbbell = body({"kind": "compound", "parts": parts}, (0, 0, 0.1), friction=0.5)
    found = plan({"dumbbell": dumbbell}).decisions["overlooked_points"]
    assert found == (True, "floor and dumbbell may touch at several points")
