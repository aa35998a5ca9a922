"""Traces made by hand, with the attributes of a read log: what replay needs and nothing else.

A ball falls 1 m, bounces twice and comes to rest beside a box that rests on four contacts.
The motion is closed-form enough to look right; no engine is involved.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from lavendersim.cell import AnyEvent, CellConfig
from lavendersim.clock import Clock
from lavendersim.trace.reader import RecordedPoses
from tests.oracle.cells import cell

G = 9.81
STEP_FIELDS = [
    ("step", "i8"),
    ("time_ns", "i8"),
    ("time", "f8"),
    ("contact_count", "i8"),
    ("total_normal_force", "f8"),
    ("max_penetration", "f8"),
    ("residual", "f8"),
]
CONTACT_FIELDS = [
    ("step", "i8"),
    ("body_a", "i8"),
    ("body_b", "i8"),
    ("feature", "i8"),
    *((name, "f8") for name in ("x", "y", "z", "nx", "ny", "nz", "penetration", "force_n")),
]


@dataclass
class SyntheticTrace:
    step: Any
    contact: Any
    pose: Any
    bodies: list[str]
    resolved: dict[str, Any]
    residual: Any = None
    as_written: str = ""
    metadata: dict[str, Any] = field(default_factory=dict)
    absent: dict[str, str] = field(default_factory=dict)
    status: str = "complete"
    complete: bool = True
    path: Path = Path("cells/ball_and_box.mcap")
    clock: Clock = field(default_factory=lambda: Clock(Fraction(1, 240)))

    @property
    def recorded_pose(self) -> RecordedPoses:
        """Rows of `step`, and their poses: all of them."""
        return RecordedPoses(self.recorded_rows("/tf"), self.pose)

    @property
    def recorded_contact(self) -> Any:
        """All contacts."""
        return self.contact

    def recorded_rows(self, topic: str) -> Any:
        """All rows of `step`."""
        return np.arange(len(self.step))

    def has(self, topic: str) -> bool:
        """Whether the log has a topic."""
        return topic not in self.absent

    @property
    def events(self) -> tuple[AnyEvent, ...]:
        """What happened to it: what its config has."""
        return self.config.events

    @property
    def config(self) -> CellConfig:
        """The cell of what `resolved` says, complete."""
        return cell(self.resolved)


def ball_and_box(steps: int = 480) -> SyntheticTrace:
    radius, edge, ball_mass, box_mass = 0.1, 0.3, 1.0, 2.0
    bodies = {
        "floor": {"shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}},
        "ball": {"shape": {"kind": "sphere", "radius": radius}, "mass": ball_mass, "fixed": False},
        "box": {"shape": {"kind": "box", "size": [edge] * 3}, "mass": box_mass, "fixed": False},
    }
    step = np.zeros(steps + 1, STEP_FIELDS)
    step["step"] = np.arange(steps + 1)
    step["time_ns"] = np.arange(steps + 1) * 1_000_000_000 // 240
    step["time"] = step["time_ns"] * 1e-9
    pose = np.zeros((steps + 1, 3, 7))
    pose[:, :, 3] = 1.0
    pose[:, 2, :3] = [0.5, 0.1, edge / 2]
    # a quarter turn about z: quaternion order mistakes show
    pose[:, 2, 3:] = [np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)]
    rows: list[tuple[Any, ...]] = []
    height, velocity, dt = 1.0, 0.0, 1 / 240
    for index in range(steps + 1):
        force = 0.0
        if index:
            velocity -= G * dt
            if height + velocity * dt < 0:
                rebound = -0.6 * velocity if velocity < -0.5 else 0.0
                force = ball_mass * (rebound - velocity) / dt
                velocity = rebound
            height = max(height + velocity * dt, 0.0)
            corner = edge / 2
            for feature, (sx, sy) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
                point = (0.5 + sx * corner, 0.1 + sy * corner, 0.0)
                rows.append((index, 0, 2, feature, *point, 0, 0, 1, 4e-4, box_mass * G / 4))
            if force > 0:
                rows.append((index, 0, 1, 0, 0, 0, 0.0, 0, 0, 1, 5e-4, force))
        pose[index, 1, :3] = [0.0, 0.0, height + radius]
        step["residual"][index] = 1e-9 * (1 + index % 7) if force > 0 else 0.0
    contact = np.array(rows, CONTACT_FIELDS)
    return SyntheticTrace(
        with_totals(step, contact), contact, pose, list(bodies), {"scene": {"bodies": bodies}}
    )


def single_ball(steps: int = 480) -> SyntheticTrace:
    """The same without the box: most steps have no contact at all."""
    trace = ball_and_box(steps)
    scene = {name: trace.resolved["scene"]["bodies"][name] for name in ("floor", "ball")}
    contact = trace.contact[trace.contact["body_b"] == 1]
    step = with_totals(trace.step, contact)
    return SyntheticTrace(
        step, contact, trace.pose[:, :2].copy(), ["floor", "ball"], {"scene": {"bodies": scene}}
    )


def with_totals(step: Any, contact: Any) -> Any:
    totals = step.copy()
    for row in totals:
        own = contact[contact["step"] == row["step"]]
        row["contact_count"] = len(own)
        row["total_normal_force"] = own["force_n"].sum()
        row["max_penetration"] = own["penetration"].max(initial=0.0)
    return totals
