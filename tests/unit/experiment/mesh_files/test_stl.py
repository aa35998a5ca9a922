"""STL: text or bytes by the file's length; corners at one place are one vertex."""

from __future__ import annotations

import struct

import pytest
from cube_files import PLACES, TRIANGLES, as_binary_stl, as_text_stl

from lavendersim.experiment.mesh_files.stl import read_stl
from lavendersim.experiment.mesh_files.triangles import MeshFileError

FACET = (
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
)


@pytest.mark.parametrize("raw", [as_text_stl(), as_binary_stl()])
def test_the_corners_of_a_cube_are_eight(raw: bytes) -> None:
    read = read_stl(raw)
    assert read.vertices == PLACES
    assert read.triangles == TRIANGLES


def test_numbers_of_32_bits_are_kept_exactly_and_zeros_are_one_place() -> None:
    numbers = (0.1, 0.0, 0.0, 1.0, -0.0, 0.0, 1.0, 0.0, 0.0)
    raw = bytes(80) + struct.pack("<I12fH", 1, 0, 0, 0, *numbers, 7)
    read = read_stl(raw)
    assert read.vertices == [
        (struct.unpack("f", struct.pack("f", 0.1))[0], 0.0, 0.0),
        (1.0, 0.0, 0.0),
    ]
    assert read.triangles == [(0, 1, 1)]


def test_a_file_may_have_several_solids_in_any_case() -> None:
    read = read_stl(f"\nSOLID a\n{FACET.upper()}endsolid a\n solid\n{FACET}endsolid\n".encode())
    assert read.triangles == [(0, 1, 2), (0, 1, 2)]
    assert read.triangle_lines == [3, 12]


@pytest.mark.parametrize(
    ("text", "line", "sentence"),
    [
        (f"solid\n{FACET}", 2, "the file ends without endsolid"),
        (f"solid\n{FACET[: FACET.index('vertex 0 1')]}", 2, "the file ends in the facet of line 2"),
        (f"solid\n{FACET}endsolid\nfacet", 10, 'expected solid, found "facet"'),
        (f"solid\n{FACET.replace('1 0 0', '1 0')}", 5, "expected vertex x y z, found 2 numbers"),
        (f"solid\n{FACET.replace('1 0 0', '1 0 inf')}", 5, 'expected a number, found "inf"'),
        (f"solid\n{FACET.replace('endloop', 'vertex 0 0 0')}", 7, "expected endloop, found "),
        ("solid\nfacet 0 0 1\n", 2, 'expected facet normal, found "facet 0 0 1"'),
        ("ply\n", 0, "expected the word solid, or 84 bytes or more, found 4 bytes"),
    ],
)
def test_the_line_that_is_wrong_is_named(text: str, line: int, sentence: str) -> None:
    with pytest.raises(MeshFileError) as caught:
        read_stl(text.encode())
    assert caught.value.line == line
    assert str(caught.value).startswith(sentence)


def test_a_number_of_bytes_that_is_none_is_named_by_its_facet() -> None:
    raw = bytearray(as_binary_stl())
    raw[84 + 50 + 12 : 84 + 50 + 16] = struct.pack("<f", float("nan"))
    with pytest.raises(MeshFileError, match="facet 1, at byte 134: expected finite numbers"):
        read_stl(bytes(raw))


def test_a_declared_number_of_facets_is_held_against_the_length() -> None:
    raw = bytes(80) + (2**32 - 1).to_bytes(4, "little") + bytes(50)
    with pytest.raises(MeshFileError, match="4294967295 facets, declared at byte 80, are"):
        read_stl(raw)
