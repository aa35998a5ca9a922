"""What a kind declares to take of every step of a log is what its function takes of it."""

from __future__ import annotations

from typing import Any, get_args

import numpy as np
import pytest
from numpy.lib.recfunctions import append_fields
from synthetic import SyntheticTrace, ball_and_floor, trace_of

from lavendersim.figures.panels.time_series import window_of
from lavendersim.figures.specs.time_series import Column, TimeSeries
from lavendersim.measures.registry import evaluate
from lavendersim.measures.specs.arithmetic import OfMeasures
from lavendersim.measures.specs.base import Measure
from lavendersim.measures.specs.catalogue import KINDS
from lavendersim.measures.specs.own import FromFile
from lavendersim.quantities.readings import CONTACTS, EVERYTHING, POSES, VELOCITIES

# Of a body that falls, bounces and comes to rest, 1.5 s at 100 Hz: longer than every window.
HEIGHTS = [0.5, 0.3, 0.0, 0.1, 0.15, 0.1, *(0.0 for _ in range(145))]
SPEEDS = [0.0, -2.0, -3.0, 1.0, 0.5, -1.0, *(0.0 for _ in range(145))]
TOUCHING = [(2, 3.0, 1e-3), *((step, 0.1, 1e-4) for step in range(6, 151))]
TILTED = {"gravity": [1.0, 0.0, -9.81]}
VALUES = {
    "body": "ball",
    "other": "floor",
    "above": "floor",
    "on": "floor",
    "wall": "floor",
    "after": 0.0,
    "last": 0.02,
    "step": 2,
    "threshold": 1e-6,
    "slower_than": 1e-3,
    "bounces": 1,
    "flips": 1,
    "along": (0.0, 0.0, 1.0),
    "part": "natural_map",
    "level": 0.1,
    "connection": "line",
}
LINE = {
    "kind": "rope",
    "between": ["floor", "ball"],
    "points": [[0.0, 0.0, 9.0], [0.0, 0.0, 0.0]],
    "length": 9.0,
    "restitution": 0.0,
}

ARM = {"kind": "ball", "between": ["floor", "ball"], "at": [0.0, 0.0, 0.0]}


# What a measure asks for may hang on the body: some are of what turns, of balls, of free bodies.
SPIN = [0.1, 5.0, 0.1]
BODIES: list[dict[str, Any]] = [
    {"position": [0.0, 0.0, 5.1]},  # falls for 1 s, and has one impact within 1.5 s
    {
        "shape": {"kind": "box", "size": [0.1, 0.2, 0.3]},
        "inertia": [1.0, 2.0, 3.0],
        "angular_velocity": SPIN,
    },
]


TAKEN = {"contact": CONTACTS, "pose": POSES, "velocity": VELOCITIES}


class Watched(SyntheticTrace):
    """A log that notes which of its tables are asked for."""

    def __getattribute__(self, name: str) -> Any:
        if name in TAKEN:
            self.__dict__.setdefault("asked", set()).update(TAKEN[name])
        return super().__getattribute__(name)

    def contacts_in_parts(self) -> Any:
        yield self.contact

    @property
    def absent(self) -> dict[str, str]:
        return {}


def watched(**body: Any) -> Watched:
    log = trace_of(HEIGHTS, TOUCHING, speeds=SPEEDS)
    spins = {f"angular_momentum_{axis}": np.ones(len(HEIGHTS)) for axis in "xyz"}
    step = append_fields(log.step, list(spins), list(spins.values()), usemask=False)
    config = ball_and_floor(**body)
    config["scene"] |= {**TILTED, "connections": {"line": LINE, "arm": ARM}}
    ropes = np.zeros(len(log.contact), np.int64)
    names = ["rope", "joint", *({*"xyz"} - {*log.contact.dtype.names})]
    contact = append_fields(log.contact, names, [ropes] * len(names), usemask=False)
    made = Watched(step=step, contact=contact, pose=log.pose, resolved=config)
    made.velocity = np.zeros((*log.pose.shape[:2], 6))
    made.__dict__["asked"] = set()
    return made


def asked_of(log: Watched) -> frozenset[str]:
    return frozenset(log.__dict__["asked"])


def spec_of(model: type[Measure], *optional: str) -> Measure:
    needed = [name for name, field in model.model_fields.items() if field.is_required()]
    given = {name: VALUES[name] for name in (*needed, *optional) if name != "kind"}
    if model in (KINDS["joint_force"], KINDS["joint_torque"]):
        given["connection"] = "arm"
    kind = get_args(model.model_fields["kind"].annotation)[0]
    return model.model_validate({"kind": kind, **given})


# A measure of a project's own may take anything, and is taken to take all.
OF_LOGS = [kind for kind, model in KINDS.items() if not issubclass(model, OfMeasures | FromFile)]


@pytest.mark.parametrize("kind", OF_LOGS)
def test_a_measure_takes_what_it_declares(kind: str) -> None:
    spec, asked = spec_of(KINDS[kind]), set[str]()
    for body in BODIES:
        log = watched(**body)
        evaluate(spec, log)
        asked |= asked_of(log)
    assert asked == spec.reads({}), kind


@pytest.mark.parametrize("kind", ["energy_drift", "energy_gain"])
def test_an_energy_above_a_plane_takes_poses(kind: str) -> None:
    log, spec = watched(), spec_of(KINDS[kind], "body", "above")
    evaluate(spec, log)
    assert asked_of(log) == spec.reads({"above": "floor"}) == POSES


@pytest.mark.parametrize("start", ["run", "first_contact"])
@pytest.mark.parametrize("column", get_args(Column))
def test_a_curve_takes_what_it_declares(column: str, start: str) -> None:
    given = {"kind": "time_series", "column": column, "start": start}
    panel = TimeSeries.model_validate(
        {**given, "body": "ball", "above": "floor", "x_label": "t", "y_label": "y"}
    )
    log = watched()
    window_of(panel, log)
    assert asked_of(log) == panel.reads(given)


def test_a_kind_that_does_not_say_may_take_anything() -> None:
    """Kinds of other packages are refused rather than left to fail after a run."""
    assert Measure.READS == EVERYTHING == CONTACTS | POSES
