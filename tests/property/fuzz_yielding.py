"""Surfaces of random configs that give way along themselves (`effects.tangential_compliance`)."""

from __future__ import annotations

from typing import Any


def give_way(
    pen: Any, numerics: dict[str, Any], scene: dict[str, Any], happens: list[dict[str, Any]]
) -> None:
    """Let surfaces with friction give way along themselves, and take away what is refused there."""
    given = [*scene["bodies"].values(), *happens]
    surfaces = [one["surface"] for one in given if isinstance(one.get("surface"), dict)]
    surfaces += [*scene.get("surfaces", {}).values(), *scene.get("surface_pairs", {}).values()]
    bodies = scene["bodies"].values()
    refused = numerics["compliance_law"] != "spring" or any("grain" in body for body in bodies)
    refused = refused or not numerics["warm_start"] or numerics["stabilisation_gain"] > 0.0
    soft = any(one.get("compliance", 0.0) > 0.0 for one in surfaces)
    if refused or not soft or not pen.has("tangential_compliance"):
        return
    scene["springs"] = []
    for surface in surfaces:
        for key in ("static_friction", "stribeck_velocity"):
            surface.pop(key, None)
        if surface.get("friction", 0.0) > 0.0 and pen.coin():
            surface["tangential_stiffness"] = pen.power(-2.0, 1.0)
            if pen.coin():
                surface["tangential_damping_ratio"] = 2.0 * pen.share()
