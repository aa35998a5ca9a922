"""Random configs that a given plan can run, as the trees of their YAML files.

Sizes are drawn over four decades, masses over six, in one scene of four over eight and eighteen. A
body stands somewhere within reach of one before it, down to the same place: most overlap, many
deeply. What drives them is drawn in `fuzz_drives`. Nothing here is meant to be sensible; all of it
is legal.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from fuzz_drives import events, forces, motion, paired, ropes, springs
from hypothesis import strategies as st

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import EFFECTS
from lavendersim.scene.laws import needs

SOLIDS = ("sphere", "box", "capsule", "cylinder", "hull", "compound")
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
    *("spring", "stabilisation", "surface_velocity", "varying_force"),
)
HULL = ((0.6, 0, -0.4), (-0.3, 0.5, -0.4), (-0.3, -0.5, -0.4), (0.1, 0.1, 0.7), (0.2, 0.3, 0.4))
EDGES = (0.0, 1.0)  # of shares: hypothesis is fond of them, and so are defects

unit = st.floats(-1.0, 1.0, allow_subnormal=False, width=32)
share = st.floats(*EDGES, allow_subnormal=False, width=32)
vector = st.tuples(unit, unit, unit)


class Drawn(NamedTuple):
    """What all scenes of one engine agree in: what is compiled in, and which laws."""

    effects: tuple[str, ...]
    shapes: tuple[str, ...]
    numerics: dict[str, Any]  # those that choose an engine
    tolerance: bool
    over_relaxation: bool

    def switches(self) -> dict[str, str]:
        """Return the section `effects` that forces all of it on."""
        shapes = {*self.shapes, "plane"} - {"compound"}
        pairs = [name for name, pair in SHAPE_PAIRS.items() if {*pair.shapes} <= shapes]
        return dict.fromkeys((*self.effects, *pairs), "on")


def _closed(names: set[str], numerics: dict[str, Any]) -> tuple[str, ...]:
    """Return the effects of these that numerics allow and that have all that they need."""
    barred = {name for name, (key, laws) in CHOSEN.items() if numerics[key] not in laws}
    if (numerics["solver"], numerics["friction_cone"]) != ("adaptive", "disc"):
        barred.add("newton")
    names = names - barred
    return tuple(sorted(name for name in names if {*needs(name)} <= names))


# Mistakes that are made on purpose break laws; an accuracy may end a run.
EVERY = {effect.name for effect in EFFECTS if not effect.study_only} - {"error_control"}
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


@st.composite
def plans(draw: Any) -> Drawn:
    """Subsets of effects and of shapes, with a solver and the laws that numerics choose."""
    solver = draw(st.sampled_from(SOLVERS))
    ordered = solver not in WITHOUT_SWEEPS
    orders = ("coloured", "forward", "backward", "symmetric", "random")
    numerics = {
        "solver": solver,
        "friction_cone": draw(st.sampled_from(("disc", "disc", "pyramid", "convex"))),
        "order": draw(st.sampled_from(orders)) if ordered else "coloured",
        "impacts": draw(st.sampled_from(IMPACTS)),
        "simultaneous_impacts": draw(st.sampled_from(("together", "pairwise"))),
        "integrator": draw(st.sampled_from(INTEGRATORS)),
        "compliance_law": draw(st.sampled_from(("spring", "regularised"))),
        "undetermined_forces": draw(st.sampled_from(("least_norm", "as_solved"))),
        "speculative": draw(st.booleans()),
    }
    spared = {name for name in SPARED if draw(st.booleans())}
    shapes = draw(st.sets(st.sampled_from(SOLIDS[:-1]), min_size=1, max_size=3))
    compound = () if "compound" in spared else ("compound",)
    return Drawn(
        _closed(EVERY - spared, numerics),
        (*sorted(shapes), *compound),
        numerics,
        tolerance=draw(st.booleans()),
        over_relaxation=ordered and draw(st.booleans()),
    )


class _Pen:
    """Draws the parts of one config."""

    duration: float  # [s] of the run, once its timestep is drawn

    def __init__(self, draw: Any, plan: Drawn) -> None:
        self.draw, self.plan = draw, plan
        self.wide = 3.0 if draw(st.integers(0, 3)) == 0 else 1.0  # decades of masses, times that
        self.calm = draw(st.integers(0, 3)) == 3  # nothing but weight gives energy

    def has(self, effect: str) -> bool:
        """Whether the plan has an effect, and this time it is required."""
        if effect not in self.plan.effects or (self.calm and effect in GIVING):
            return False
        return bool(self.draw(st.booleans()))

    def power(self, low: float, high: float) -> float:
        """Return ten to the power of something between."""
        return float(10.0 ** self.draw(st.floats(low, high, allow_subnormal=False, width=32)))

    def signed(self, low: float, high: float) -> float:
        """Return a power of ten of either sign."""
        return self.power(low, high) * float(self.draw(st.sampled_from((-1.0, 1.0))))

    def some_vector(self, low: float, high: float) -> list[float]:
        """Return a vector that is not zero."""
        made = self.vector(self.power(low, high))
        return made if any(made) else [10.0**low, 0.0, 0.0]

    def vector(self, size: float) -> list[float]:
        """Return a vector no longer than sqrt(3) sizes."""
        return [size * x for x in self.draw(vector)]

    def share(self, low: float = 0.0) -> float:
        """Return something from `low` to 1."""
        return low + (1.0 - low) * float(self.draw(share))

    def turn(self) -> list[float]:
        """Return no rotation, or any but those by half a turn."""
        return [1.0, *(self.vector(1.0) if self.draw(st.booleans()) else (0.0, 0.0, 0.0))]

    def shape(self, kind: str, size: float) -> dict[str, Any]:
        """Return a shape of which no point is much farther from its centre than `size`."""
        if kind == "sphere":
            return {"kind": kind, "radius": size}
        if kind == "box":
            return {"kind": kind, "size": [size * self.share(0.01) for _ in range(3)]}
        if kind in ("capsule", "cylinder"):
            radius, length = 0.5 * size * self.share(0.02), size * self.share(0.02)
            return {"kind": kind, "radius": radius, "length": length}
        if kind == "hull":
            points = [[size * (c + 0.1 * self.draw(unit)) for c in point] for point in HULL]
            return {"kind": kind, "points": points}
        simple = st.sampled_from(tuple(k for k in self.plan.shapes if k != "compound"))
        parts = [
            {
                "shape": self.shape(self.draw(simple), 0.5 * size),
                "position": self.vector(0.4 * size),
                "orientation": self.turn(),
            }
            for _ in range(self.draw(st.integers(1, 3)))
        ]
        return {"kind": kind, "parts": parts}

    def surface(self, size: float) -> dict[str, float]:
        """Return what a surface of a body so large may do."""
        made = {}
        if self.has("friction"):
            made["friction"] = self.draw(st.sampled_from((0.5, 1.0, 10.0))) * self.share()
        if self.has("torsional_friction"):
            made["torsional_friction"] = size * self.share()
        if self.has("rolling_friction"):
            made["rolling_friction"] = size * self.share()
        if made.get("friction", 0.0) > 0.0 and self.has("static_friction"):
            made["static_friction"] = made["friction"] * (1.0 + 2.0 * self.share())
            made["stribeck_velocity"] = self.power(-4.0, 1.0)
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

    def body(self, first: bool, near: tuple[np.ndarray, float]) -> tuple[dict[str, Any], float]:
        """Return a body within reach of another one (its centre and size), and its size."""
        decades = 2.0 if self.wide == 1.0 else 4.0
        size = self.power(-decades, decades)
        place = near[0] + (near[1] + size) * np.array(self.draw(vector)) * self.share()
        body: dict[str, Any] = {
            "shape": self.shape(self.draw(st.sampled_from(self.plan.shapes)), size),
            "position": place.tolist(),
            "orientation": self.turn(),
            "surface": self.surface(size),
        }
        if self.has("surface_velocity"):
            body["surface_velocity"] = self.vector(self.power(-2.0, 1.0))
        way = self.draw(st.integers(0, 7))
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
        plan, draw = self.plan, self.draw
        rate = draw(st.one_of(st.sampled_from((30, 60, 240, 10_000)), st.integers(30, 10_000)))
        relaxed = 0.02 + 1.96 * self.share() if plan.over_relaxation else 1.0
        # A gain excludes impacts in order and springs of contacts: it is idle beside them.
        excluded = {"impact_order", "contact_spring"} & {*plan.effects}
        gains = not excluded and self.has("stabilisation")
        return {
            **plan.numerics,
            "timestep": f"1/{rate}",
            "sweeps": draw(st.integers(1, 60)),
            "over_relaxation": 0.5 if plan.over_relaxation and relaxed == 1.0 else relaxed,
            "tolerance": self.power(-14.0, 0.0) if plan.tolerance else None,
            "warm_start": self.has("warm_start"),
            "stabilisation_gain": 2.0 * self.share() if gains else 0.0,
            "slop": self.power(-9.0, -2.0) * self.share(),
            "projection": self.share() if self.has("projection") else 0.0,
            "projection_sweeps": draw(st.integers(0, 30)),
            "restitution_threshold": 10.0 * self.share(),
            "cache_distance": self.power(-4.0, 1.0) * self.share(),
            "cache_normal_cosine": draw(unit),
            "sleeping": self.has("sleeping"),
            "sleep_speed": self.power(-4.0, 1.0),
            "sleep_time": 0.2 * self.share(),
        }


@st.composite
def configs(draw: Any, plan: Drawn) -> dict[str, Any]:
    """Two to eight bodies, for 20 to 60 steps, as the tree of a config."""
    pen = _Pen(draw, plan)
    numerics = pen.numerics()
    pen.duration = float(draw(st.integers(20, 60)) * Fraction(numerics["timestep"]))
    bodies: dict[str, Any] = {}
    sizes: dict[str, float] = {}
    places = [(np.zeros(3), 0.0)]
    for k in range(draw(st.integers(2, 8))):
        body, size = pen.body(k == 0, places[draw(st.integers(0, len(places) - 1))])
        bodies[f"body_{k}"], sizes[f"body_{k}"] = body, size
        places.append((np.array(body["position"]), size))
    if draw(st.booleans()):
        shape = {"kind": "plane", "offset": -pen.power(-2.0, 1.0)}
        bodies["floor"] = {"shape": shape, "surface": pen.surface(1.0)}
    movable = [name for name, body in bodies.items() if "mass" in body]
    gravity = pen.vector(pen.power(-1.0, 2.0)) if pen.has("gravity") else [0.0, 0.0, 0.0]
    named = paired(pen, bodies)
    pushed = forces(pen, movable, pen.duration)
    times = {"timestep": numerics["timestep"], "duration": pen.duration}
    return {
        "scene": {
            **named,
            "gravity": gravity,
            "bodies": bodies,
            "forces": pushed,
            "springs": springs(pen, bodies, movable),
            "connections": ropes(pen, sizes, movable),
        },
        "events": [] if pen.calm else events(pen, bodies, movable, pushed, times),
        "numerics": numerics,
        "duration": pen.duration,
        "record": {
            "residuals": "all" if pen.has("residual_log") else "none",
            "problems": "none",  # few scenes can be written as FCLIB files
        },
        "effects": plan.switches(),
    }
