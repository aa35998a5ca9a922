"""What connects bodies of a drawn scene: ropes, and joints of each kind with stops and motors.

Functions take the pen of `fuzz_scenes`, which draws numbers and knows what the plan has.
"""

from __future__ import annotations

from typing import Any

from lavendersim.engine.effects.joint import IMPACTS, SOLVERS
from lavendersim.engine.effects.joint_models import JOINTS

WITH_AXIS = ("hinge", "slider")


def connections(
    pen: Any, bodies: dict[str, Any], sizes: dict[str, float], movable: list[str]
) -> dict[str, Any]:
    """Return ropes and joints between bodies; none where nothing can be connected."""
    if len(bodies) < 2:
        return {}
    return {**ropes(pen, sizes, movable), **joints(pen, bodies, sizes, movable)}


def ropes(pen: Any, sizes: dict[str, float], movable: list[str]) -> dict[str, Any]:
    """Return ropes between points of bodies: taut as the run begins, slack, or too short."""
    if not pen.has("rope") or len(sizes) < 2:
        return {}
    made: dict[str, Any] = {}
    for k in range(pen.integer(1, 2)):
        one = pen.one_of(movable)
        other = pen.one_of([name for name in sizes if name != one])
        rope: dict[str, Any] = {
            "kind": "rope",
            "between": [one, other],
            "points": [pen.vector(0.5 * sizes[name]) for name in (one, other)],
        }
        if pen.coin():
            rope["length"] = pen.power(-2.0, 2.0)
        if pen.has("restitution"):
            rope["restitution"] = pen.share()
        made[f"rope_{k}"] = rope
    return made


def may_join(plan: Any) -> bool:
    """Whether scenes of a plan may have joints, by its laws."""
    laws = plan.numerics
    alone = laws["impacts"] != "in_order" or laws["simultaneous_impacts"] == "together"
    return alone and laws["solver"] in SOLVERS and laws["impacts"] in IMPACTS


def joints(
    pen: Any, bodies: dict[str, Any], sizes: dict[str, float], movable: list[str]
) -> dict[str, Any]:
    """Return joints of any kind at points of the first body, free, stopped, driven or braked.

    Nobody is joined twice: what several joints hold, few sweeps tear.
    """
    if not may_join(pen.plan) or not pen.has("joint"):
        return {}
    made: dict[str, Any] = {}
    loose = list(sizes)
    for k in range(pen.integer(1, 3)):
        free = [name for name in movable if name in loose]
        others = [name for name in loose if name not in free[:1]]
        if not free or not others:
            break
        one = free[0]
        other = pen.one_of(others)
        loose = [name for name in loose if name not in (one, other)]
        beside = pen.vector(0.5 * sizes[one])
        joint: dict[str, Any] = {
            "kind": pen.one_of(JOINTS),
            "between": [one, other] if pen.coin() else [other, one],
            "at": [x + dx for x, dx in zip(bodies[one]["position"], beside, strict=True)],
        }
        if pen.coin():
            joint["collide"] = True
        if joint["kind"] in WITH_AXIS:
            joint |= along_axis(pen, joint["kind"], sizes[one])
        made[f"joint_{k}"] = joint
    return made


def along_axis(pen: Any, kind: str, size: float) -> dict[str, Any]:
    """Return the axis of a joint, its stops and its motor."""
    made: dict[str, Any] = {"axis": pen.some_vector(0.0, 0.0)}
    far = size if kind == "slider" else 3.0
    if pen.has("joint_stop"):
        made["limits"] = [-far * pen.share(), far * pen.share(0.01)]
    if pen.has("motor"):
        speed = pen.signed(-2.0, 2.0) if pen.coin() else 0.0  # 0: a brake
        most = "max_force" if kind == "slider" else "max_torque"
        made["motor"] = {"speed": speed, most: pen.power(-3.0, 4.0)}
    return made
