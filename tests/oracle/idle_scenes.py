"""Small scenes with contacts that matter, each without something that another one has.

Shapes are spheres where they will do: their kernels compile in a third of the time of boxes'.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from laboratory import body, box, plane, resolved, sphere

from lavendersim.cell import Numerics
from lavendersim.experiment.resolve.presets import CHAPTER, DEFAULT

GRAVITY = (0.0, 0.0, -9.81)  # [m/s^2]
NOWHERE = (0.0, 0.0, 0.0)
TILTED = (1.0, 0.4, -0.3, 0.2)
CUBE = (0.24, 0.24, 0.24)
BRICK = (0.3, 0.24, 0.16)
CONJUGATE = {"solver": "nonsmooth_conjugate_gradient", "sweeps": 20}
HULL = ((0.2, 0, -0.12), (-0.1, 0.17, -0.12), (-0.1, -0.17, -0.12), (0.02, 0.03, 0.25))


def _numerics(preset: Numerics) -> dict[str, Any]:
    return preset.model_dump(mode="json")


# bare: captured impacts and projected Gauss-Seidel, without any repair of penetration.
PRESETS: dict[str, dict[str, Any]] = {
    "bare": {},
    "chapter": _numerics(CHAPTER),
    "default": _numerics(DEFAULT),
}


def cell(bodies: dict[str, Any], gravity: Any = GRAVITY, preset: str = "bare", **numerics: Any):
    """Return a resolved cell that does not ask for the residual of every sweep."""
    made = resolved(bodies, gravity, **{**PRESETS[preset], **numerics})
    made["record"]["residuals"] = "none"
    return made


def mistaken(made: dict[str, Any]) -> dict[str, Any]:
    """Return a cell whose restitution, if it had any, would be captured in the sweeps."""
    made["study"]["mistake"] = "capture_in_sweeps"
    return made


def balls(**surface: float) -> dict[str, Any]:
    """A ball at rest, one that falls on it off centre, one that runs into both, one of 8 kg."""
    return {
        "floor": plane(**surface),
        "low": sphere(0.1, (0.0, 0.0, 0.1), **surface),
        "high": sphere(0.08, (0.03, 0.02, 0.4), velocity=(0.0, 0.0, -1.0), **surface),
        "runner": sphere(0.1, (-0.6, 0.05, 0.1), velocity=(2.0, 0.0, 0.0), **surface),
        "heavy": sphere(0.15, (0.5, -0.3, 0.3), velocity=(-1.5, 1.0, 0.0), mass=8.0, **surface),
    }


def slow(**surface: float) -> dict[str, Any]:
    """Two balls, one on the floor, with too little energy to be fast in any step."""
    falling = sphere(0.08, (0.03, 0.02, 0.27), velocity=(0.2, 0.1, 0.0), **surface)
    return {"floor": plane(**surface), "low": sphere(0.1, (0.0, 0.0, 0.1), **surface), "b": falling}


def boxes(size: Any = BRICK, **surface: float) -> dict[str, Any]:
    """A stack of two, and a box at an odd angle that lands on an edge and runs into it."""
    return {
        "floor": plane(**surface),
        "low": box(size, (0.0, 0.0, 0.5 * size[2]), **surface),
        "high": box(size, (0.04, 0.02, 1.5 * size[2]), **surface),
        "thrown": box(
            size,
            (-0.7, 0.05, 0.4),
            orientation=TILTED,
            velocity=(2.5, 0.0, -1.0),
            angular_velocity=(1.0, 3.0, -2.0),
            mass=2.0,
            **surface,
        ),
    }


def mixed(**surface: float) -> dict[str, Any]:
    """Balls and a box that slide on a frictional floor; one ball is frictionless."""
    bodies = {**balls(**surface), "brick": boxes(**surface)["thrown"]}
    bodies["high"]["surface"] = dict.fromkeys(bodies["high"]["surface"], 0.0)
    return bodies


def spinning() -> dict[str, Any]:
    """Frictionless balls that spin: their contacts exert no torque."""
    bodies = balls()
    for k, name in enumerate(("low", "high", "runner", "heavy")):
        bodies[name]["angular_velocity"] = [1.0 + k, -2.0, 3.0 * k]
    return bodies


def drifting() -> dict[str, Any]:
    """Balls that nothing accelerates; two of them bounce between the third and the floor."""
    bodies = balls(restitution=0.8)
    bodies["low"]["velocity"], bodies["high"]["velocity"] = [0.3, 0.1, -0.4], [0.0, 0.0, -2.0]
    return bodies


def flying() -> dict[str, Any]:
    """A brick in free flight: nothing can touch it, and nothing turns it."""
    return {"brick": box(BRICK, (0.0, 0.0, 5.0), orientation=TILTED, velocity=(1.0, 0.0, 2.0))}


def single() -> dict[str, Any]:
    """A frictionless ball on a floor: one point."""
    return {"floor": plane(), "ball": sphere(0.1, (0.0, 0.0, 0.12), restitution=0.3)}


def others(**surface: float) -> dict[str, Any]:
    """Every shape but spheres and boxes, thrown at each other over a floor."""
    shapes: tuple[dict[str, Any], ...] = (
        {"kind": "hull", "points": [list(point) for point in HULL]},
        {"kind": "capsule", "radius": 0.12, "length": 0.25},
        {"kind": "cylinder", "radius": 0.16, "length": 0.3},
        {"kind": "ellipsoid", "semi_axes": [0.15, 0.12, 0.1]},
        {"kind": "cone", "radius": 0.14, "height": 0.3},
    )
    bodies = {"floor": plane(**surface)}
    for k, (shape, x) in enumerate(zip(shapes, (-0.5, 0.0, 0.5, 1.0, 1.5), strict=True)):
        properties = {"orientation": TILTED, "velocity": (-3.0 * x, 0.0, -1.0), **surface}
        bodies[shape["kind"]] = body(shape, (x, 0.05 * k, 0.35), **properties)
    return bodies


SCENES: dict[str, Callable[[], dict[str, Any]]] = {
    "balls": lambda: cell(balls(restitution=0.5)),
    "plastic balls": lambda: cell(balls()),
    "plastic balls, mistaken": lambda: mistaken(cell(balls())),
    "cold balls": lambda: cell(balls(), warm_start=False),
    "spinning balls": lambda: cell(spinning()),
    "frictional balls": lambda: cell(balls(friction=0.4)),
    "drifting balls": lambda: cell(drifting(), NOWHERE, integrator="midpoint"),
    "conjugate balls": lambda: cell(balls(friction=0.4), **CONJUGATE),
    "adaptive balls": lambda: cell(
        balls(friction=0.4), solver="adaptive", sweeps=50, tolerance=1e-9
    ),
    "slow balls": lambda: cell(slow(), speculative=True),
    "slow frictionless impacts": lambda: cell(slow(restitution=0.7), impacts="at_surface"),
    "slow frictional impacts": lambda: cell(slow(friction=0.4), impacts="at_surface"),
    "boxes": lambda: cell(boxes()),
    "frictional boxes": lambda: cell(boxes(friction=0.4)),
    "frictional cubes": lambda: cell(boxes(CUBE, friction=0.4)),
    "mixed": lambda: cell(mixed(friction=0.4)),
    "others": lambda: cell(others(friction=0.3)),
    "flying brick": lambda: cell(flying(), preset="default", simultaneous_impacts="pairwise"),
    "single ball": lambda: cell(
        single(), solver="adaptive", sweeps=50, undetermined_forces="least_norm"
    ),
    "balls, chapter": lambda: cell(balls(restitution=0.5), preset="chapter"),
    "boxes, chapter": lambda: cell(boxes(), preset="chapter"),
    "mixed, chapter": lambda: cell(mixed(friction=0.4, restitution=0.3), preset="chapter"),
    "conjugate boxes, chapter": lambda: cell(boxes(), preset="chapter", **CONJUGATE),
    "single ball, default": lambda: cell(single(), preset="default"),
    "drifting balls, default": lambda: cell(drifting(), NOWHERE, preset="default"),
    "plastic balls, default": lambda: cell(balls(), preset="default"),
    "balls, default": lambda: cell(balls(restitution=0.5), preset="default"),
    "boxes, default": lambda: cell(boxes(), preset="default"),
    "mixed, default": lambda: cell(mixed(friction=0.4, restitution=0.3), preset="default"),
    "others, default": lambda: cell(others(), preset="default"),
}

# For each effect scenes that do not require it, with what it would act on if it did.
CASES: dict[str, tuple[str, ...]] = {
    "compound": ("frictional balls",),
    "rope": ("balls",),
    "joint": ("balls",),
    "joint_stop": ("balls",),
    "motor": ("balls",),
    "broad_phase": ("balls",),
    "periodic_boundary": ("balls", "boxes, default"),
    "gravity": ("drifting balls",),
    "external_force": ("frictional balls",),
    "varying_force": ("frictional balls",),
    "drag": ("frictional balls",),
    "rotation": ("balls",),
    "gyroscopic": ("frictional balls", "flying brick"),  # round bodies; one that is not, nor turns
    "kinematic": ("balls",),
    "prescribed_motion": ("frictional balls",),
    "contact_torque": ("spinning balls",),
    "frictionless_contact": ("frictional balls",),
    "friction": ("balls", "boxes"),
    "anisotropic_friction": ("frictional balls",),
    "contact_patch": ("frictional boxes",),
    "torsional_friction": ("frictional balls",),
    "tangential_restitution": ("slow frictional impacts",),
    "rolling_friction": ("frictional balls",),
    "surface_velocity": ("frictional balls",),
    "spring": ("frictional balls",),
    "static_friction": ("frictional balls",),
    "cohesion": ("frictional balls", "balls"),
    "midpoint": ("drifting balls",),
    "contact_midpoint": ("flying brick",),
    "impact_time": ("flying brick",),
    "impact_order": ("flying brick",),
    "pairwise_impacts": ("flying brick",),
    "sliding_stops": ("flying brick",),
    "overlooked_points": ("balls, default",),
    "speculative": ("flying brick",),
    "fast_bodies": ("slow balls",),
    # Captured; at the time of impact it idles in the second kind of test_idle_subsets.
    "falling_restitution": ("balls",),
    "restitution": ("plastic balls",),
    "capture_in_sweeps": ("plastic balls, mistaken",),
    "impact_energy": ("slow frictionless impacts", "slow frictional impacts"),
    "stabilisation": ("balls",),
    "compliance": ("balls", "conjugate balls"),
    "contact_spring": ("flying brick",),
    "hertz_contact": ("flying brick",),
    "tangential_compliance": ("flying brick",),
    "warm_start": ("cold balls",),
    "newton": ("single ball",),
    "supernodes": ("adaptive balls",),
    "least_norm": ("single ball",),
    "packed_sweeps": ("adaptive balls",),
    "anderson_acceleration": ("adaptive balls",),
    "projection": ("balls",),
    "sleeping": ("frictional balls",),
    "triggers": ("balls",),
    "step_log": ("balls",),
    "pose_log": ("balls",),
    "velocity_log": ("balls",),
    "contact_log": ("balls",),
    "residual_log": ("balls", "adaptive balls"),
    "problem_log": ("balls",),
}
# Whose scenes are not logged.
UNLOGGED = {"step_log", "pose_log", "contact_log"}
