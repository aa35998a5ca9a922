"""Paths that a sweep may vary, and the sentence where one leads nowhere."""

from __future__ import annotations

import pytest

from lavendersim.experiment.sweeps.paths import find_path
from lavendersim.experiment.text.node import Mark, Node
from lavendersim.experiment.text.parse import parse
from lavendersim.experiment.text.report import Report

ROOT = parse(
    b"""
scene:
  gravity: 9.81
  surfaces: {wood: {friction: 0.5}}
  bodies:
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1], surface: wood}
events: [{at: 0.1, body: ball, velocity: [0, 0, 0]}]
duration: 1
""",
    Report("a.yaml"),
)


def followed(path: str) -> tuple[object, str]:
    """Return the steps of a path, and what is said of it."""
    report = Report("a.yaml")
    assert ROOT is not None
    found = find_path(Node(path, Mark(1, 1)), ROOT, report)
    return found, "".join(defect.message for defect in report.defects)


@pytest.mark.parametrize(
    ("path", "steps"),
    [
        ("duration", ("duration",)),
        ("scene.bodies.ball.position.2", ("scene", "bodies", "ball", "position", 2)),
        ("scene.bodies.ball.shape.radius", ("scene", "bodies", "ball", "shape", "radius")),
        ("scene.surfaces.wood.friction", ("scene", "surfaces", "wood", "friction")),
        ("events.0.velocity.1", ("events", 0, "velocity", 1)),
        ("numerics.timestep", ("numerics", "timestep")),
        ("scene.bodies.ball.shape.kind", ("scene", "bodies", "ball", "shape", "kind")),
        ("scene.bodies.ball.surface", ("scene", "bodies", "ball", "surface")),
        ("scene.bodies.ball.surface.friction", ("scene", "bodies", "ball", "surface", "friction")),
        ("scene.bodies.ball.drag.linear", ("scene", "bodies", "ball", "drag", "linear")),
        ("scene.bodies.ball.velocity", ("scene", "bodies", "ball", "velocity")),
    ],
)
def test_a_path_leads_to_its_value(path: str, steps: tuple[str | int, ...]) -> None:
    assert followed(path) == (steps, "")


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("question", 'a sweep cannot reach "question"'),
        ("scene.bodies.ball", "scene.bodies.ball is a mapping; name one value inside it"),
        ("scene.bodies.ball.maas", 'did you mean "mass"?'),
        ("duration.length", 'duration is a single value, there is no "length" in it'),
        ("events.1.at", 'events has items 0 to 0, there is no "1"'),
        ("scene.forces.0.force", "scene.forces is no list in this file; write it, then"),
        ("scene.bodies.ball.velocity.0", "velocity is no list in this file; write it, then"),
        ("scene.bodies.cube.mass", 'there is no "cube" in scene.bodies; valid here: ball'),
        ("scene.gravity.degrees", "write it as a mapping to sweep degrees"),
        ("scene.bodies.ball.release.phase", "release is not written in this file; write it"),
        ("scene.shapes.brick.size", 'no "brick" in scene.shapes; nothing is written there'),
        ("scene.surfaces", "scene.surfaces is a mapping; name one value inside it"),
        ("scene.bodies.ball.shape.kind.x", 'is a single value, there is no "x" in it'),
    ],
)
def test_a_path_that_leads_nowhere_says_why(path: str, words: str) -> None:
    found, said = followed(path)
    assert found is None
    assert words in said
