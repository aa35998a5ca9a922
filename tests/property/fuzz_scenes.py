"""Random configs that a given plan can run, as the trees of their YAML files.

Sizes are drawn over four decades, masses over six, in one scene of four over eight and eighteen. A
body stands somewhere within reach of one before it, down to the same place: most overlap, many
deeply. What drives them is drawn in `fuzz_drives`. Nothing here is meant to be sensible; all of it
is legal.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml
from fuzz_cavities import cavity
from fuzz_draws import Draw
from fuzz_drives import events, forces, motion, paired, springs
from fuzz_grounds import ground
from fuzz_joints import connections
from fuzz_yielding import give_way

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import EFFECTS
from lavendersim.engine.effects.joint_models import JOINTS
from lavendersim.scene.laws import needs

# Drawn engines choose among the first: another one there would draw others of the same seed.
SIMPLE = ("sphere", "box", "capsule", "cylinder", "hull")
SOLIDS = (*SIMPLE, "compound", "ellipsoid", "cone")
SOLVERS = (
    "adaptive",
    "projected_gauss_seidel",
    "block_gauss_seidel",
    "coloured_gauss_seidel",
    "nonsmooth_conjugate_gradient",
    "jacobi",
    "accelerated_projected_gradient",
)
IMPACTS = ("captured", "at_surface", "in_order")
INTEGRATORS = ("semi_implicit_euler", "midpoint", "midpoint_contact")
WITHOUT_SWEEPS = ("jacobi", "accelerated_projected_gradient")  # they know no order of contacts
CHOSEN: dict[str, tuple[str, tuple[Any, ...]]] = {  # effects that are there by the numerics alone
    "impact_time": ("impacts", ("at_surface", "in_order")),
    "impact_order": ("impacts", ("in_order",)),
    "pairwise_impacts": ("simultaneous_impacts", ("pairwise",)),
    "midpoint": ("integrator", ("midpoint", "midpoint_contact")),
    "contact_midpoint": ("integrator", ("midpoint_contact",)),
    "contact_spring": ("compliance_law", ("spring",)),
    "least_norm": ("undetermined_forces", ("least_norm",)),
    "speculative": ("speculative", (True,)),
}
# Effects that a drawn plan may leave out: of each it is known what requires it.
SPARED = (
    *("broad_phase", "compliance", "compound", "drag", "external_force", "friction", "gravity"),
    *("kinematic", "problem_log", "projection", "residual_log", "restitution", "rolling_friction"),
    *("sleeping", "stabilisation", "surface_velocity", "torsional_friction", "warm_start"),
)
# Effects that may give energy, or give back what they stored.
GIVING = (
    *("cohesion", "compliance", "external_force", "prescribed_motion", "projection", "restitution"),
    *("motor", "spring", "stabilisation", "surface_velocity", "tangential_restitution"),
    "varying_force",
)
HULL = ((0.6, 0, -0.4), (-0.3, 0.5, -0.4), (-0.3, -0.5, -0.4), (0.1, 0.1, 0.7), (0.2, 0.3, 0.4))


class Drawn(NamedTuple):
    """What all scenes of one engine agree in: what is compiled in, and which laws."""

    effects: tuple[str, ...]
    shapes: tuple[str, ...]
    numerics: dict[str, Any]  # those that choose an engine
    tolerance: bool
    over_relaxation: bool
    accurate: bool = False  # whether each run asks for an accuracy, with substeps

    def switches(self) -> dict[str, str]:
        """Return the section `effects` that forces all of it on."""
        shapes = {*self.shapes, "plane", "bowl", "drum", "mesh"} - {"compound"}
        pairs = [name for name, pair in SHAPE_PAIRS.items() if {*pair.shapes} <= shapes]
        return dict.fromkeys((*self.effects, *pairs), "on")

    def has_all_of(self, tree: dict[str, Any]) -> bool:
        """Whether a config chooses these laws, and forces on no more than this engine has."""
        laws = {key: tree["numerics"].get(key) for key in self.numerics}
        return laws == self.numerics and tree.get("effects", {}).items() <= self.switches().items()


@cache
def found_once() -> dict[str, dict[str, Any]]:
    """Return the configs of what the fuzz has found, by the names of their files."""
    files = sorted((Path(__file__).parents[2] / "configs" / "hard" / "found").glob("*.yaml"))
    return {file.stem: yaml.safe_load(file.read_text(encoding="utf-8")) for file in files}


def _closed(names: set[str], numerics: dict[str, Any]) -> tuple[str, ...]:
    """Return the effects of these that numerics allow and that have all that they need."""
    barred = {name for name, (key, laws) in CHOSEN.items() if numerics[key] not in laws}
    if (numerics["solver"], numerics["friction_cone"]) != ("adaptive", "disc"):
        barred.add("newton")
    names = names - barred
    return tuple(sorted(name for name in names if {*needs(name)} <= names))


# Effects that no scene requires, and why; all others are (`test_fuzz.py`).
NOT_DRAWN = {
    "hertz_contact": "no compliance may be beside it; see tests/physics/test_hertz_contacts.py",
    "capture_in_sweeps": "a mistake that is made on purpose, which breaks laws",
    "periodic_boundary": "scenes here have walls, or none; see test_periodic_boundary.py",
    "supernodes": "of hundreds of bodies; here envelopes are small; see `test_panels.py`",
    "anderson_acceleration": "of long solves of hundreds of bodies; see `test_extrapolation.py`",
}
# Those whose kernels run since the engine has them, though no scene is large enough, or asks.
FORCED = {
    "broad_phase": "of thousands of pairs; here the tree is made for a few",
    "packed_sweeps": "of many bodies; here lanes are packed for a few",
    "problem_log": "few scenes can be written as FCLIB files: none is asked for",
    "velocity_log": "columns of states that others have",
}
# Laws that steps of fixed length have no part in: of the engine that is asked for an accuracy.
ACCURACY = "error_control"
EVERY = {effect.name for effect in EFFECTS} - {*NOT_DRAWN, ACCURACY}
LAWS: dict[str, Any] = {
    "solver": "adaptive",
    "friction_cone": "disc",
    "order": "coloured",
    "impacts": "in_order",
    "simultaneous_impacts": "pairwise",
    "integrator": "midpoint_contact",
    "compliance_law": "spring",
    "undetermined_forces": "least_norm",
    "speculative": True,
}
FULL = Drawn(_closed(EVERY, LAWS), SOLIDS, LAWS, tolerance=True, over_relaxation=False)
# Every body may be joined: joints pass impacts on at once, so no plan has all effects in one scene.
JOINED = FULL._replace(numerics={**LAWS, "simultaneous_impacts": "together"})
JOINED = JOINED._replace(effects=_closed(EVERY, JOINED.numerics))
# Asked for an accuracy: by laws of second order, of few shapes, for each step is made of substeps.
ACCURATE = Drawn(
    tuple(sorted((*FULL.effects, ACCURACY))), ("sphere", "box"), LAWS, True, False, accurate=True
)


def plan_of(draw: Draw) -> Drawn:
    """Return a subset of effects and of shapes, with a solver and the laws that numerics choose."""
    solver = draw.one_of(SOLVERS)
    ordered = solver not in WITHOUT_SWEEPS
    orders = ("coloured", "forward", "backward", "symmetric", "random")
    numerics = {
        "solver": solver,
        "friction_cone": draw.one_of(("disc", "disc", "pyramid", "convex")),
        "order": draw.one_of(orders) if ordered else "coloured",
        "impacts": draw.one_of(IMPACTS),
        "simultaneous_impacts": draw.one_of(("together", "pairwise")),
        "integrator": draw.one_of(INTEGRATORS),
        "compliance_law": draw.one_of(("spring", "regularised")),
        "undetermined_forces": draw.one_of(("least_norm", "as_solved")),
        "speculative": draw.coin(),
    }
    spared = {name for name in SPARED if draw.coin()}
    shapes = draw.some_of(SIMPLE, 3)
    compound = () if "compound" in spared else ("compound",)
    return Drawn(
        _closed(EVERY - spared, numerics),
        (*sorted(shapes), *compound),
        numerics,
        tolerance=draw.coin(),
        over_relaxation=ordered and draw.coin(),
    )


class _Pen(Draw):
    """Draws the parts of one config."""

    duration: float  # [s] of the run, once its timestep is drawn
    rolls = True  # whether surfaces may have rolling friction: not beside a grain

    def __init__(self, seed: str, plan: Drawn) -> None:
        super().__init__(seed)
        self.plan = plan
        self.wide = 3.0 if self.integer(0, 3) == 0 else 1.0  # decades of masses, times that
        self.calm = self.integer(0, 3) == 3  # nothing but weight gives energy

    def beside(self, seed: str) -> _Pen:
        """Return a pen for the same scene that takes none of this one's draws."""
        pen = _Pen(seed, self.plan)
        pen.wide, pen.calm, pen.duration = self.wide, self.calm, self.duration
        return pen

    def has(self, effect: str) -> bool:
        """Whether the plan has an effect, and this time it is required."""
        if effect not in self.plan.effects or (self.calm and effect in GIVING):
            return False
        return bool(self.coin())

    def turn(self) -> list[float]:
        """Return no rotation, or any but those by half a turn."""
        return [1.0, *(self.vector(1.0) if self.coin() else (0.0, 0.0, 0.0))]

    def shape(self, kind: str, size: float) -> dict[str, Any]:
        """Return a shape of which no point is much farther from its centre than `size`."""
        if kind == "sphere":
            return {"kind": kind, "radius": size}
        if kind == "box":
            return {"kind": kind, "size": [size * self.share(0.01) for _ in range(3)]}
        if kind in ("capsule", "cylinder"):
            radius, length = 0.5 * size * self.share(0.02), size * self.share(0.02)
            return {"kind": kind, "radius": radius, "length": length}
        if kind == "ellipsoid":
            return {"kind": kind, "semi_axes": [size * self.share(0.02) for _ in range(3)]}
        if kind == "cone":
            return {"kind": kind} | {k: size * self.share(0.02) for k in ("radius", "height")}
        if kind == "hull":
            points = [[size * (c + 0.1 * self.unit()) for c in point] for point in HULL]
            return {"kind": kind, "points": points}
        simple = tuple(kind for kind in self.plan.shapes if kind != "compound")
        parts = [
            {
                "shape": self.shape(self.one_of(simple), 0.5 * size),
                "position": self.vector(0.4 * size),
                "orientation": self.turn(),
            }
            for _ in range(self.integer(1, 3))
        ]
        return {"kind": kind, "parts": parts}

    def surface(self, size: float) -> dict[str, float]:
        """Return what a surface of a body so large may do."""
        made = {}
        if self.has("friction"):
            made["friction"] = self.one_of((0.5, 1.0, 10.0)) * self.share()
        if self.has("torsional_friction"):
            made["torsional_friction"] = size * self.share()
        if self.rolls and self.has("rolling_friction"):
            made["rolling_friction"] = size * self.share()
        if made.get("friction", 0.0) > 0.0:
            made |= self.sliding(made["friction"])
        if self.has("cohesion"):
            made["cohesion"] = self.power(-3.0, 3.0)
        if self.has("restitution"):
            made["restitution"] = self.share()
            if self.has("falling_restitution"):
                made["yield_speed"] = self.power(-2.0, 1.0)
        if self.has("compliance"):
            made["compliance"] = self.power(-9.0, -2.0)
            if self.has("contact_spring"):
                made["damping_ratio"] = 2.0 * self.share()
        return made

    def sliding(self, friction: float) -> dict[str, float]:
        """Return what a surface with friction may have beside it."""
        made = {}
        if self.has("static_friction"):
            made["static_friction"] = friction * (1.0 + 2.0 * self.share())
            made["stribeck_velocity"] = self.power(-4.0, 1.0)
        if self.has("contact_patch"):
            made["friction_reach"] = self.share()
        if self.plan.numerics["impacts"] == "in_order" and self.has("tangential_restitution"):
            made["tangential_restitution"] = self.share()
        return made

    def body(self, first: bool, near: tuple[np.ndarray, float]) -> tuple[dict[str, Any], float]:
        """Return a body within reach of another one (its centre and size), and its size."""
        decades = 2.0 if self.wide == 1.0 else 4.0
        size = self.power(-decades, decades)
        place = near[0] + (near[1] + size) * np.array(self.vector(1.0)) * self.share()
        body: dict[str, Any] = {
            "shape": self.shape(self.one_of(self.plan.shapes), size),
            "position": place.tolist(),
            "orientation": self.turn(),
            "surface": self.surface(size),
        }
        if self.has("surface_velocity"):
            body["surface_velocity"] = self.vector(self.power(-2.0, 1.0))
        way = self.integer(0, 7)
        if way == 0 and not first:
            return {**body, "fixed": True}, size
        if way == 1 and not first and self.has("prescribed_motion"):
            return {**body, "kinematic": True, "motion": motion(self, self.duration)}, size
        body["velocity"] = self.vector(self.power(-2.0, 2.0))
        body["angular_velocity"] = self.vector(self.power(-2.0, 2.0))
        if way == 1 and not first and "kinematic" in self.plan.effects and not self.calm:
            return {**body, "kinematic": True}, size
        body["mass"] = self.power(-3.0 * self.wide, 3.0 * self.wide)
        if self.has("drag"):
            names = ("linear", "quadratic", "angular")
            body["drag"] = {name: self.power(-3.0, 1.0) * self.share() for name in names}
        return body, size

    def numerics(self) -> dict[str, Any]:
        """Return all of the numerics."""
        plan = self.plan
        rate = self.one_of((30, 60, 240, 10_000, *(self.integer(30, 10_000) for _ in range(4))))
        relaxed = 0.02 + 1.96 * self.share() if plan.over_relaxation else 1.0
        # A gain excludes impacts in order and springs of contacts: it is idle beside them.
        excluded = {"impact_order", "contact_spring"} & {*plan.effects}
        gains = not excluded and self.has("stabilisation")
        substeps: dict[str, Any] = {}
        if plan.accurate:
            shortest = 1.0 / (rate * 2.0 ** self.integer(3, 9))
            substeps = {"accuracy": self.power(-4.0, -0.05), "smallest_timestep": shortest}
        return {
            **plan.numerics,
            **substeps,
            "timestep": f"1/{rate}",
            "sweeps": self.integer(1, 60),
            "over_relaxation": 0.5 if plan.over_relaxation and relaxed == 1.0 else relaxed,
            "tolerance": self.power(-14.0, 0.0) if plan.tolerance else None,
            "warm_start": self.has("warm_start"),
            "stabilisation_gain": 2.0 * self.share() if gains else 0.0,
            "slop": self.power(-9.0, -2.0) * self.share(),
            "projection": self.share() if self.has("projection") else 0.0,
            "projection_sweeps": self.integer(0, 30),
            "restitution_threshold": 10.0 * self.share(),
            "cache_distance": self.power(-4.0, 1.0) * self.share(),
            "cache_normal_cosine": self.unit(),
            "sleeping": self.has("sleeping"),
            "sleep_speed": self.power(-4.0, 1.0),
            "sleep_time": 0.2 * self.share(),
        }

    def steps(self) -> int:
        """Return how many steps a run has: some have a few, one in eight as many as sleep needs."""
        return self.integer(40, 60) if self.integer(0, 7) == 0 else self.integer(5, 24)


def config_of(seed: str, plan: Drawn) -> dict[str, Any]:
    """Return the tree of a config: two to eight bodies, for 5 to 60 steps."""
    pen = _Pen(seed, plan)
    numerics = pen.numerics()
    pen.duration = float(pen.steps() * Fraction(numerics["timestep"]))
    bodies: dict[str, Any] = {}
    sizes: dict[str, float] = {}
    places = [(np.zeros(3), 0.0)]
    for k in range(pen.integer(2, 8)):
        body, size = pen.body(k == 0, pen.one_of(places))
        bodies[f"body_{k}"], sizes[f"body_{k}"] = body, size
        places.append((np.array(body["position"]), size))
    if pen.coin():
        shape = {"kind": "plane", "offset": -pen.power(-2.0, 1.0)}
        bodies["floor"] = {"shape": shape, "surface": pen.surface(1.0)}
    cavity(pen.beside(f"{seed} cavity"), bodies, sizes)
    ground(pen.beside(f"{seed} ground"), bodies, sizes)
    grain(pen, bodies)
    movable = [name for name, body in bodies.items() if "mass" in body]
    scene: dict[str, Any] = {
        **paired(pen, bodies),
        "gravity": pen.vector(pen.power(-1.0, 2.0)) if pen.has("gravity") else [0.0, 0.0, 0.0],
        "bodies": bodies,
        "forces": forces(pen, movable, pen.duration),
        "connections": connections(pen, bodies, sizes, movable),
    }
    joined = any(one["kind"] in JOINTS for one in scene["connections"].values())
    apart = joined and numerics["integrator"] != "midpoint_contact"  # refused beside each other
    scene["springs"] = [] if apart else springs(pen, bodies, movable)
    times = {"timestep": numerics["timestep"], "duration": pen.duration}
    happens = [] if pen.calm else events(pen, bodies, movable, scene, times)
    give_way(pen.beside(f"{seed} along"), numerics, scene, happens)
    return {
        "scene": scene,
        "events": happens,
        "numerics": numerics | ({"sleeping": False} if joined else {}),
        "duration": pen.duration,
        "record": {
            "residuals": "all" if pen.has("residual_log") else "none",
            "problems": "none",  # few scenes can be written as FCLIB files
        },
        "effects": plan.switches(),
    }


def grain(pen: _Pen, bodies: dict[str, Any]) -> None:
    """Give some bodies a grain, and surfaces with friction another one across it.

    Torques have no ellipse, nor has a pyramid: they cannot be with it.
    """
    surfaces = [body["surface"] for body in bodies.values()]
    frictional = [one for one in surfaces if one.get("friction", 0.0) > 0.0]
    if pen.plan.numerics["friction_cone"] == "pyramid" or not frictional:
        return
    if not pen.has("anisotropic_friction"):
        return
    pen.rolls = False
    for surface in surfaces:
        surface.pop("rolling_friction", None)
    for surface in frictional:
        surface["across_grain"] = pen.power(-2.0, 1.0)
    for name in pen.some_of([*bodies], len(bodies)):
        bodies[name]["grain"] = pen.some_vector(0.0, 0.0)
