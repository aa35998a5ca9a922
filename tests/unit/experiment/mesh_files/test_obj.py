"""OBJ: polygons become triangles, numbers count from 1 or back; the rest is no surface."""

from __future__ import annotations

from codecs import BOM_UTF8

import pytest

from lavendersim.experiment.mesh_files.obj import read_obj
from lavendersim.experiment.mesh_files.triangles import MeshFileError

SQUARE = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def test_a_convex_polygon_is_cut_from_its_first_corner() -> None:
    read = read_obj(SQUARE + b"f 2 3 4 1\n")
    assert read.triangles == [(1, 2, 3), (1, 3, 0)]
    assert read.triangle_lines == [5, 5]


def test_a_mark_of_utf_8_is_no_statement() -> None:
    assert read_obj(BOM_UTF8 + SQUARE + b"f 1 2 3 4\n").vertices[1] == (1.0, 0.0, 0.0)


def test_numbers_count_back_and_texture_and_normals_are_left_out() -> None:
    text = SQUARE + b"vt 0 0\nvn 0 0 1\ng side # a name\nusemtl red\nf -4/1 -3/1/1 \\\n -1//1\n"
    read = read_obj(text)
    assert read.triangles == [(0, 1, 3)]
    assert read.triangle_lines == [10]


def test_a_weight_of_one_and_a_colour_stand_behind_a_place() -> None:
    read = read_obj(b"v 1e-1 -.5 2. 1.0\nv 1 2 3 0.5 0.5 0.5\nv 1 2 3 1 0 0 0\n")
    assert read.vertices == [(0.1, -0.5, 2.0), (1.0, 2.0, 3.0), (1.0, 2.0, 3.0)]


STAR = b"".join(b"v %d %d 0\n" % place for place in ((0, 3), (-2, -3), (3, 1), (-3, 1), (2, -3)))


@pytest.mark.parametrize(
    ("text", "line", "sentence"),
    [
        (b"v 0 0\n", 1, "expected v x y z, found 2 numbers"),
        (b"v 0 0 0 2\n", 1, "expected a weight of 1, found 2"),
        (b"v 0 0 1_0\n", 1, 'expected a number, found "1_0"'),
        (b"v 0 0 1e999\n", 1, 'expected a number, found "1e999"'),
        (b"v 0 0 nan\n", 1, 'expected a number, found "nan"'),
        (b"v 0 0 \xb2\n", 1, 'expected a number, found "²"'),
        (b"\nsolid cube\n", 2, 'expected v or f, found "solid"'),
        (SQUARE + b"f 1 2\n", 5, "expected three vertices or more, found 2"),
        (SQUARE + b"f 1 2 5\n", 5, "there are 4 vertices above, from 1; found 5"),
        (SQUARE + b"f 1 2 0\n", 5, "there are 4 vertices above, from 1; found 0"),
        (SQUARE + b"f 1 2 -5\n", 5, "there are 4 vertices above, from 1; found -5"),
        (SQUARE + b"f 1 2 3.0\n", 5, 'expected the number of a vertex, found "3.0"'),
        (SQUARE + b"f 1 2 " + b"9" * 5000, 5, "expected the number of a vertex"),
        (SQUARE + b"f 1 3 2 4\n", 5, "a polygon of 4 corners is not convex"),
        (SQUARE + b"v 0.5 0.1 0\nf 1 5 2 3 4\n", 6, "a polygon of 5 corners is not convex"),
        (SQUARE + b"v 0.5 0 0\nf 1 5 2 3 4\n", 6, "a polygon of 5 corners is not convex"),
        (STAR + b"f 1 2 3 4 5\n", 6, "a polygon of 5 corners is not convex"),
        (SQUARE + b"f 1 2 \\", 5, "the file ends within a statement"),
    ],
)
def test_the_line_at_fault_is_named(text: bytes, line: int, sentence: str) -> None:
    with pytest.raises(MeshFileError) as caught:
        read_obj(text)
    assert caught.value.line == line
    assert str(caught.value).startswith(sentence)
