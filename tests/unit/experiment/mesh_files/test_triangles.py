"""Vertices of a file: welded where they are at one place to the last bit, and not beside it."""

from __future__ import annotations

import math

import pytest

from lavendersim.experiment.mesh_files.triangles import FileTriangles, coordinate, shown


def test_a_vertex_is_welded_at_its_place_alone() -> None:
    read = FileTriangles()
    beside = math.nextafter(1.0, 2.0)
    places = ((1.0, 0.0, 0.0), (beside, 0.0, 0.0), (1.0, -0.0, 0.0))
    assert [read.weld_vertex(place, line) for line, place in enumerate(places)] == [0, 1, 0]
    assert read.vertices == [*places[:2]]
    assert read.vertex_lines == [0, 1]


@pytest.mark.parametrize(("word", "value"), [(b"-1.5e-3", -0.0015), (b"+2", 2.0), (b".5", 0.5)])
def test_numbers_are_read_as_python_reads_them(word: bytes, value: float) -> None:
    assert coordinate(word, 1) == value


def test_a_word_of_any_bytes_is_shown_on_one_line() -> None:
    assert shown(b"a\x00\x1b[1m\xff") == '"a\ufffd\ufffd[1m\xff"'
