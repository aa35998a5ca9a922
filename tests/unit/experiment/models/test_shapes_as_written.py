"""Shapes as written: which kinds there are, and turns by a quaternion or an angle about an axis."""

from __future__ import annotations

import math

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.models.shapes import KINDS, SOLIDS, TURNED, Hull
from lavendersim.experiment.schema import json_schema
from tests.marked_config import FLOOR, assert_refused, config, refusals, scene

CUBE = "points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]"


def with_shape(words: str, orientation: str = "[1, 0, 0, 0]") -> str:
    rest = f"mass: 1, position: [0, 0, 9], orientation: {orientation}"
    return config(scene=scene(FLOOR, f"it: {{shape: {{{words}}}, {rest}}}"))


def test_only_hulls_and_compounds_have_principal_axes_of_their_own() -> None:
    assert TURNED == ("hull", "compound")
    assert set(SOLIDS) == {
        "sphere",
        "box",
        "capsule",
        "cylinder",
        "ellipsoid",
        "cone",
        "hull",
        "compound",
    }
    assert set(KINDS) == set(SOLIDS) - {"compound"}


def test_corners_of_a_hull_are_its_points() -> None:
    points = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    assert Hull(kind="hull", points=points).corners() == points


@pytest.mark.parametrize(
    ("orientation", "expected"),
    [
        # half a turn by 90 degrees about z: cos 45, sin 45
        ("{axis: [0, 0, 2], degrees: 90}", (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))),
        ("[0, 3, 0, 0]", (0.0, 1.0, 0.0, 0.0)),
    ],
)
def test_turns_in_both_forms_become_unit_quaternions(
    orientation: str, expected: tuple[float, ...]
) -> None:
    text = with_shape("kind: box, size: [1, 2, 3]", orientation)
    body = load_experiment_text(text, "a.yaml").cells()[0].config.scene.bodies["it"]
    assert body.orientation == pytest.approx(expected, abs=4e-16)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (
            "kind: hull, points: §[[0, 0, 0], [1, 0, 0], [0, 1, 0]]",
            "points: expected 4 items or more, found 3",
        ),
        (
            "kind: compound, parts: §[]",
            "parts: expected 1 item or more, found none",
        ),
        (
            f"kind: compound, parts: [{{shape: {{kind: §compound, {CUBE}}}}}]",
            'unknown kind "compound" in scene.bodies.it.shape.parts[0].shape; '
            "valid here: sphere, box, capsule, cylinder, ellipsoid, cone, hull",
        ),
        (
            "kind: §sphair, radius: 1",
            'unknown kind "sphair" in scene.bodies.it.shape; did you mean "sphere"?',
        ),
    ],
)
def test_shapes_that_cannot_be_are_refused_at_their_place(words: str, sentence: str) -> None:
    assert_refused(with_shape(words), sentence)


def test_an_orientation_of_another_form_says_both() -> None:
    assert_refused(
        with_shape("kind: sphere, radius: 1", "§30"),
        "orientation: expected a quaternion [w, x, y, z] or {axis: [x, y, z], degrees: angle}, "
        "found 30",
    )
    found = refusals(with_shape("kind: sphere, radius: 1", "[0, 0, 0, 0]"))
    assert len(found) == 1


def test_an_editor_may_write_the_name_of_a_shape() -> None:
    """`shape: name` is replaced before a config is validated; the schema has to know of it."""
    body = json_schema()["definitions"]["Body"]["properties"]["shape"]
    assert {"type": "string"} in body["anyOf"]
