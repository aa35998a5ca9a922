"""Logs made by hand, with known answers: a stand-in for an opened trace, and for a sweep's cell."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np
import numpy.lib.recfunctions as recfunctions

from lavendersim.cell import AnyEvent, CellConfig
from lavendersim.clock import Clock
from lavendersim.measures.free_rotation import free_rotation
from tests.oracle.cells import cell

STEP = [
    ("step", "i8"),
    ("time", "f8"),
    ("residual", "f8"),
    ("kinetic_energy", "f8"),
    ("potential_energy", "f8"),
    ("momentum_x", "f8"),
    ("momentum_y", "f8"),
    ("momentum_z", "f8"),
]
CONTACT = [
    ("step", "i8"),
    ("body_a", "i8"),
    ("body_b", "i8"),
    ("nx", "f8"),
    ("ny", "f8"),
    ("nz", "f8"),
    ("separation", "f8"),
    ("penetration", "f8"),
    ("approach_velocity", "f8"),
    ("normal_velocity", "f8"),
    ("impulse_n", "f8"),
    ("force_n", "f8"),
    ("inverse_effective_mass", "f8"),
]
RESIDUAL = [("step", "i8"), ("sweep", "i8"), ("residual", "f8")]
GRAVITY = 9.81
RADIUS = 0.1
MASS = 2.0


def ball_and_floor(**changes: Any) -> dict[str, Any]:
    """A resolved config: a ball of 2 kg, released 1 m above a floor, e = 0.5."""
    ball = {
        "shape": {"kind": "sphere", "radius": RADIUS},
        "mass": MASS,
        "surface": {"restitution": 0.5, "compliance": 1e-5},
        "position": [0.0, 0.0, 1.0 + RADIUS],
        "orientation": [1.0, 0.0, 0.0, 0.0],
        "velocity": [0.0, 0.0, 0.0],
        "angular_velocity": [0.0, 0.0, 0.0],
    }
    floor = {
        "shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0},
        "fixed": True,
        "position": [0.0, 0.0, 0.0],
    }
    return {
        "scene": {
            "gravity": [0.0, 0.0, -GRAVITY],
            "bodies": {"floor": floor, "ball": ball | changes},
        },
        "events": [],
        "numerics": {
            "timestep": "1/100",
            "slop": 0.001,
            "projection": 0.2,
            "stabilisation_gain": 0.02,
        },
    }


@dataclass
class SyntheticTrace:
    """What a measure may ask of a log."""

    step: Any
    contact: Any
    pose: Any
    residual: Any = field(default_factory=lambda: np.zeros(0, RESIDUAL))
    bodies: Sequence[str] = ("floor", "ball")
    resolved: Mapping[str, Any] = field(default_factory=ball_and_floor)
    clock: Clock = field(default_factory=lambda: Clock(Fraction(1, 100)))
    status: str = "complete"
    absent: ClassVar[Mapping[str, str]] = MappingProxyType({})

    def contacts_in_parts(self) -> Iterator[Any]:
        """Yield the contacts, in one part."""
        yield self.contact

    @property
    def events(self) -> tuple[AnyEvent, ...]:
        """What happened to it: what its config has."""
        return self.config.events

    @property
    def config(self) -> CellConfig:
        """The cell of what `resolved` says, complete."""
        return cell(self.resolved)


@dataclass
class SyntheticCell:
    """A cell of a sweep with a log, or with an error in its place."""

    coordinates: Mapping[str, Any]
    log: Any
    path: Path = Path("runs/some-run/cells/some-cell.mcap")

    @property
    def label(self) -> str:
        return ", ".join(f"{axis}={value}" for axis, value in self.coordinates.items())

    @property
    def status(self) -> str:
        return str(self.trace().status)

    @property
    def config(self) -> CellConfig:
        config: CellConfig = self.trace().config
        return config

    def trace(self) -> Any:
        if isinstance(self.log, Exception):
            raise self.log
        return self.log


def steps(heights: Sequence[float], speeds: Sequence[float] | None = None) -> np.ndarray:
    """One row per state of the ball: clearances [m] and, if they matter, velocities [m/s]."""
    rows = np.zeros(len(heights), STEP)
    rows["step"] = np.arange(len(heights))
    rows["time"] = rows["step"] / 100.0
    rows["potential_energy"] = MASS * GRAVITY * (np.asarray(heights) + RADIUS)
    if speeds is not None:
        rows["kinetic_energy"] = 0.5 * MASS * np.square(speeds)
        rows["momentum_z"] = MASS * np.asarray(speeds)
    return rows


def poses(heights: Sequence[float]) -> np.ndarray:
    """Poses of floor and ball for the clearances [m]."""
    table = np.zeros((len(heights), 2, 7))
    table[:, :, 3] = 1.0
    table[:, 1, 2] = np.asarray(heights) + RADIUS
    return table


def contacts(rows: Sequence[tuple[int, float, float]]) -> np.ndarray:
    """Contacts of floor and ball from (step, impulse [N s], penetration [m])."""
    table = np.zeros(len(rows), CONTACT)
    for row, (step, impulse, penetration) in zip(table, rows, strict=True):
        row["step"], row["body_a"], row["body_b"] = step, 0, 1
        row["nz"] = 1.0
        row["separation"], row["penetration"] = -penetration, penetration
        row["impulse_n"], row["force_n"] = impulse, impulse * 100.0
        row["approach_velocity"], row["normal_velocity"] = -2.0, 1.0
        row["inverse_effective_mass"] = 1.0 / MASS
    return table


def trace_of(
    heights: Sequence[float],
    touching: Sequence[tuple[int, float, float]] = (),
    speeds: Sequence[float] | None = None,
    **changes: Any,
) -> SyntheticTrace:
    """A log of the ball from clearances, contacts and velocities."""
    return SyntheticTrace(
        step=steps(heights, speeds),
        contact=contacts(touching),
        pose=poses(heights),
        **changes,
    )


def scene_of(bodies: Mapping[str, Mapping[str, Any]], **changes: Any) -> dict[str, Any]:
    """A resolved config of these bodies; one without a mass is fixed."""
    filled = {
        name: {"fixed": "mass" not in entry, "orientation": [1.0, 0.0, 0.0, 0.0]} | dict(entry)
        for name, entry in bodies.items()
    }
    scene = {"gravity": [0.0, 0.0, -GRAVITY], "bodies": filled} | changes
    return ball_and_floor() | {"scene": scene}


def log_of(
    resolved: Mapping[str, Any], places: Any, quaternions: Any = None, **changes: Any
) -> SyntheticTrace:
    """A log from centres (rows, bodies, 3) [m] and orientations (rows, bodies, 4), 100 Hz."""
    places = np.asarray(places, dtype=float)
    table = np.zeros((*places.shape[:2], 7))
    table[:, :, :3] = places
    table[:, :, 3:] = [1.0, 0.0, 0.0, 0.0] if quaternions is None else quaternions
    return SyntheticTrace(
        step=steps([0.0] * len(places)),
        contact=contacts([]),
        pose=table,
        bodies=tuple(resolved["scene"]["bodies"]),
        resolved=resolved,
        **changes,
    )


def spinning_log(slow: float = 0.0, moments: tuple[float, ...] = (1.0, 2.0, 3.0)) -> SyntheticTrace:
    """The exact motion, its clock wrong by a share: L fixed in the world, omega in body axes."""
    omega = np.array([0.01, 5.0, 0.01])
    body = {
        "shape": {"kind": "box", "size": [1.0, 1.0, 1.0]},
        "mass": 2.0,
        "inertia": list(moments),
        "angular_velocity": omega.tolist(),
    }
    exact = free_rotation(np.array(moments), omega)
    rates = exact.angular_velocity(np.arange(2001) / 100.0 * (1.0 - slow))
    log = log_of(scene_of({"top": body}), np.tile([3.0, -1.0, 2.0], (2001, 1, 1)))
    # any rotation that takes I omega to the fixed L will do: here turn the world, not the body
    momentum = rates * moments + np.cross([3.0, -1.0, 2.0], [0.5, 0.25, -0.125])
    columns = {f"angular_momentum_{axis}": momentum[:, k] for k, axis in enumerate("xyz")}
    log.step = recfunctions.append_fields(
        log.step, list(columns), list(columns.values()), usemask=False
    )
    # moving, so that L about the origin has an orbital part that must be taken off
    for axis, value in zip("xyz", (0.5, 0.25, -0.125), strict=True):
        log.step[f"momentum_{axis}"] = value
    return log
