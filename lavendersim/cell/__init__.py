"""The resolved cell: one frozen, typed config of what is simulated, hashed and logged."""

from lavendersim.cell.body import CellBody, Release
from lavendersim.cell.choices import (
    CAPTURE_IN_SWEEPS,
    NO_MISTAKE,
    FrictionCone,
    Impacts,
    Integrator,
    Mistake,
    Order,
    Preset,
    Solver,
    Switch,
)
from lavendersim.cell.config import CellConfig, CellEffects, CellStudy
from lavendersim.cell.engine import CellEngine
from lavendersim.cell.events import (
    AnyEvent,
    CellEvent,
    CellGravity,
    CellTimestep,
    changes_of_bodies,
    changes_of_gravity,
)
from lavendersim.cell.numerics import Numerics
from lavendersim.cell.record import CellRecord, TimeWindow
from lavendersim.cell.scene import CellForce, CellScene
from lavendersim.cell.shapes import (
    Box,
    Capsule,
    CellCompound,
    CellHull,
    CellPart,
    CellShape,
    CellSimple,
    Convex,
    Cylinder,
    Ellipsoid,
    Plane,
    Sphere,
)
from lavendersim.cell.surface import PairedSurface, PairProperties, Partner, Surface
from lavendersim.cell.triggers import CellTrigger, CellTriggeredEvent, happened, met_after

__all__ = [
    "CAPTURE_IN_SWEEPS",
    "NO_MISTAKE",
    "AnyEvent",
    "Box",
    "Capsule",
    "CellBody",
    "CellCompound",
    "CellConfig",
    "CellEffects",
    "CellEngine",
    "CellEvent",
    "CellForce",
    "CellGravity",
    "CellHull",
    "CellPart",
    "CellRecord",
    "CellScene",
    "CellShape",
    "CellSimple",
    "CellStudy",
    "CellTimestep",
    "CellTrigger",
    "CellTriggeredEvent",
    "Convex",
    "Cylinder",
    "Ellipsoid",
    "FrictionCone",
    "Impacts",
    "Integrator",
    "Mistake",
    "Numerics",
    "Order",
    "PairProperties",
    "PairedSurface",
    "Partner",
    "Plane",
    "Preset",
    "Release",
    "Solver",
    "Sphere",
    "Surface",
    "Switch",
    "TimeWindow",
    "changes_of_bodies",
    "changes_of_gravity",
    "happened",
    "met_after",
]
