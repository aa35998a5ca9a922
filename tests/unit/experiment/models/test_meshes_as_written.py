"""A mesh has vertices and triangles, or a file of them, which no text without a folder has."""

from __future__ import annotations

import pytest

from tests.marked_config import BALL, assert_refused, config, scene

VERTICES = "vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]"


@pytest.mark.parametrize(
    ("mesh", "sentences"),
    [
        (
            f"§{{kind: mesh, {VERTICES}}}",
            ['missing key "triangles" in scene.bodies.part.shape: a list of [row, row, row] of '
             "vertices, or a file: part.stl"],
        ),
        (
            f"{{kind: mesh, {VERTICES}, §triangle: [[0, 1, 2]]}}",
            ['unknown key "triangle" in scene.bodies.part.shape; did you mean "triangles"?'],
        ),
        (
            "{kind: mesh, file: §part.stl}",
            ["file: a config given as text has no folder to look in; expected vertices and "
             "triangles, or a config that is a file"],
        ),
        (
            f"{{kind: mesh, {VERTICES}, triangles: [[0, 1, 2]], scale: §0}}",
            ["scale: expected a number above 0, found 0"],
        ),
    ],
)  # fmt: skip
def test_what_a_mesh_lacks_is_named(mesh: str, sentences: list[str]) -> None:
    part = f"part: {{shape: {mesh}, position: [0, 0, 0]}}"
    assert_refused(config(scene=scene(part, BALL)), *sentences)
