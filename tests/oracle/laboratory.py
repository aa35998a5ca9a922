"""Scenes in a few words and engines at their initial state, shared by the engine's tests.

Every engine of a test session is built from a few specs, because each spec costs a compilation.
"""

from __future__ import annotations

import json
from typing import Annotated, Any

import numpy as np
from pydantic import Field, TypeAdapter

from lavendersim.cell import CellConfig
from lavendersim.engine.effects import BODY_KEYS, EFFECTS, MOTION_KEYS, SURFACE_KEYS
from lavendersim.engine.engine import Engine, Rows
from lavendersim.engine.records import ROWS_FULL
from lavendersim.engine.spec import Spec
from lavendersim.experiment.models.shapes import Solid
from lavendersim.experiment.resolve.shape import resolve_shape
from lavendersim.scene.build import Scene, build
from lavendersim.scene.plan import Plan, plan_of
from tests.made_cells import NUMERICS

# Effects that put another law in a law's place: no coefficient of theirs takes them away.
OTHER_LAWS = {
    *("broad_phase", "capture_in_sweeps", "fast_bodies", "impact_energy", "impact_time"),
    *("contact_midpoint", "contact_spring", "error_control", "hertz_contact", "impact_order"),
    *("midpoint", "newton", "supernodes", "tangential_compliance"),
    "anderson_acceleration",
    *("least_norm", "overlooked_points", "pairwise_impacts", "sleeping", "sliding_stops"),
    *("joint", "joint_stop", "motor"),  # rows without a cone, beside which none are packed
    "speculative",
    "triggers",  # that end a call of the engine
    "velocity_log",  # rows of poses that go on with velocities
}
# Every other effect and the shapes of most tests: one compilation serves them.
EVERYTHING = Spec(
    effects=tuple(sorted(effect.name for effect in EFFECTS if effect.name not in OTHER_LAWS)),
    shape_pairs=("box_box", "box_plane", "sphere_box", "sphere_plane", "sphere_sphere"),
    tolerance=True,
)

WALLS = ("plane", "bowl", "drum", "mesh")  # what never has a mass
SOLID: TypeAdapter[Any] = TypeAdapter(Annotated[Solid, Field(discriminator="kind")])


def body(shape: dict[str, Any], position=(0.0, 0.0, 0.0), **properties: Any) -> dict[str, Any]:
    """Return one resolved body; mass 1 kg unless given. Hulls and compounds: as written."""
    surface = {key.name: properties.pop(key.name, key.default) for key in SURFACE_KEYS}
    by_effect = {key.name: properties.pop(key.name) for key in BODY_KEYS if key.name in properties}
    moves = any(by_effect.get(key.name) for key in MOTION_KEYS)
    wall = shape["kind"] in WALLS
    fixed = properties.pop("fixed", moves or wall)
    mass = None if fixed else properties.pop("mass", 1.0)
    inertia = None
    if not wall:
        solid = resolve_shape(SOLID.validate_json(json.dumps(shape), strict=False))
        shape = solid.shape.model_dump(mode="json")
        inertia = None if fixed else [mass * moment for moment in solid.inertia_per_mass]
    return {
        "shape": shape,
        "fixed": fixed,
        "mass": mass,
        "density": None,
        "inertia": properties.pop("inertia", inertia),
        "surface": surface,
        **by_effect,
        "position": list(position),
        "release": None,
        "orientation": list(properties.pop("orientation", (1.0, 0.0, 0.0, 0.0))),
        "velocity": list(properties.pop("velocity", (0.0, 0.0, 0.0))),
        "angular_velocity": list(properties.pop("angular_velocity", (0.0, 0.0, 0.0))),
    }


def sphere(radius: float, position, **properties: Any) -> dict[str, Any]:
    """Return a sphere."""
    return body({"kind": "sphere", "radius": radius}, position, **properties)


def box(size, position, **properties: Any) -> dict[str, Any]:
    """Return a box of full edge lengths `size`."""
    return body({"kind": "box", "size": list(size)}, position, **properties)


def plane(normal=(0.0, 0.0, 1.0), offset: float = 0.0, **properties: Any) -> dict[str, Any]:
    """Return a half space."""
    return body({"kind": "plane", "normal": list(normal), "offset": offset}, **properties)


def resolved(bodies: dict[str, Any], gravity=(0.0, 0.0, 0.0), **numerics: Any) -> dict[str, Any]:
    """Return a resolved cell as data; `config` makes the typed one of it."""
    return {
        "scene": {"gravity": list(gravity), "bodies": bodies, "forces": []},
        "events": [],
        "duration": 1.0,
        "numerics": {**NUMERICS, **numerics},
        "record": {"residuals": "all", "problems": "none"},
        "effects": {"force": False, "switches": {}},
        "study": {"mistake": "none"},
    }


def config(cell: dict[str, Any]) -> CellConfig:
    """Return a resolved cell as the rooms take it."""
    return CellConfig.from_dict(cell)


def planned(cell: dict[str, Any], record: bool = True) -> Plan:
    """Return the plan of a resolved cell."""
    return plan_of(config(cell), record)


class Bench:
    """A scene and its engine; `run` gathers every row it writes."""

    def __init__(
        self, cell: dict[str, Any], spec: Spec | None = EVERYTHING, block_steps: int = 512
    ):
        self.spec = spec or planned(cell).spec
        self.cell = cell
        self.scene: Scene = build(config(cell), self.spec)
        self.engine: Engine = self.scene.engine(self.spec, block_steps)
        self.status = 0

    @property
    def velocity(self) -> np.ndarray:
        """Linear velocities, shape (bodies, 3)."""
        return np.array([list(row)[:3] for row in self.engine.velocities])

    @property
    def spin(self) -> np.ndarray:
        """Angular velocities, shape (bodies, 3)."""
        return np.array([list(row)[3:6] for row in self.engine.velocities])

    def run(self, steps: int) -> Rows:
        """Advance by `steps`, or until divergence, and return all rows."""
        target = int(self.engine.counters["step"][0]) + steps
        blocks = []
        while True:
            self.status = self.engine.advance(target - int(self.engine.counters["step"][0]))
            blocks.append(self.engine.take_rows())
            if self.status != ROWS_FULL:
                break
        return Rows(*(np.concatenate(columns) for columns in zip(*blocks, strict=True)))
