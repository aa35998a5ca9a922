"""Runs of configs without files, for the tests of physics: the recorded rows of each cell."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from interpreted_steps import interpreted_advance

from lavendersim.engine.records import DIVERGED, RUNNING
from lavendersim.experiment import load_experiment_text
from lavendersim.runner.plans import shared_plans
from lavendersim.scene.build import build
from lavendersim.scene.events import EventQueue
from tests.families_of_plans import spec_of_family

GRAVITY = 9.81  # [m/s^2], what a config has that states none


class Course(NamedTuple):
    """One cell that was run: what the engine recorded, row by row."""

    coordinates: dict[str, Any]
    names: list[str]
    dt: float  # [s]
    step: np.ndarray
    pose: np.ndarray
    contact: np.ndarray

    def height(self, body: str) -> np.ndarray:
        """Return the height of the body's centre at every step [m]."""
        return self.pose[:, self.names.index(body), 2]

    def contacts_of(self, body: str, other: str) -> np.ndarray:
        """Return the contact rows between two bodies."""
        pair = {self.names.index(body), self.names.index(other)}
        rows = self.contact
        return rows[[{a, b} == pair for a, b in zip(rows["body_a"], rows["body_b"], strict=True)]]


def run_config(text: str, *, interpreted: bool = False) -> list[Course]:
    """Run every cell of a config as a run does: one plan for all that can share it.

    interpreted: by kernels in the interpreter, which have the same bits, for a few dozen steps.
    """
    cells = load_experiment_text(text, "test.yaml").cells()
    courses = []
    for cell, plan in zip(cells, shared_plans(cells), strict=True):
        spec = plan.spec if interpreted else spec_of_family(plan)
        scene = build(cell.config, spec)
        engine = scene.engine(spec)
        if interpreted:
            engine._entry = interpreted_advance(spec)
        changes = EventQueue(engine, scene, cell.config.events, cell.config.triggered)
        blocks, done, last = [], 0, cell.config.steps
        while True:
            changes.apply_due(done)
            status = engine.advance(changes.next_stop(last) - done)
            done = int(engine.counters["step"][0])
            blocks.append(engine.take_rows())
            assert status != DIVERGED, f"{cell.label}: body {engine.counters['body'][0]} diverged"
            if status == RUNNING and done >= last:
                break
        step, pose, contact, _ = (np.concatenate(rows) for rows in zip(*blocks, strict=True))
        dt = float(cell.config.numerics.timestep)
        courses.append(Course(cell.coordinates, scene.names, dt, step, pose, contact))
    return courses


def first_apex(course: Course, body: str, radius: float) -> float:
    """Return the clearance of a ball above z = 0 at its first apex after it touched [m].

    The highest sample: at most g dt^2 / 8 below the vertex of the parabola through it.
    """
    gap = course.height(body) - radius
    touched = int(np.argmax(course.step["contact_count"] > 0))
    rising = gap[touched:]
    end = int(np.argmax(np.diff(rising) < 0))
    return float(rising[end])
