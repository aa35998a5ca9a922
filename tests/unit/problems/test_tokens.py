"""Words and numbers of a problem file; what does not fit is reported with its place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lavendersim.errors import ProblemError
from lavendersim.problems.tokens import Tokens


def tokens(folder: Path, text: str) -> Tokens:
    """Return the tokens of a text."""
    file = folder / "a.dat"
    file.write_text(text)
    return Tokens(file)


def test_words_one_after_the_other(tmp_path: Path) -> None:
    found = tokens(tmp_path, "name 3\n  1.5 -2e3\t0.25 7: 8")
    assert found.peek(2) == ["name", "3"]
    assert found.word() == "name"
    assert found.whole("a count") == 3
    assert found.numbers(3, "sizes").tolist() == [1.5, -2000.0, 0.25]
    assert found.wholes(2, "places").tolist() == [7, 8]
    assert found.left == 0


def test_entries_are_places_and_a_value_however_they_are_printed(tmp_path: Path) -> None:
    places, values = tokens(tmp_path, "0 1: 2.5\n3.0 2e0: -1").entries(2, 2, "entries")
    assert places.tolist() == [[0, 1], [3, 2]]
    assert places.dtype == np.int64
    assert values.tolist() == [2.5, -1.0]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("1 2\n 3 x", 'a.dat:2:4: expected sizes, 4 numbers, found "x"'),
        ("1 2 nan 4", 'a.dat:1:5: expected sizes, finite, found "nan"'),
        ("1 2\n3", "a.dat:2: expected sizes, 4 numbers, but the file ends after 3"),
    ],
)
def test_numbers_that_do_not_fit(tmp_path: Path, text: str, sentence: str) -> None:
    with pytest.raises(ProblemError) as error:
        tokens(tmp_path, text).numbers(4, "sizes")
    assert str(error.value).endswith(sentence)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("1.5", "expected a count, a whole number"),
        ("-1", "expected a count, at least 0"),
        ("9" * 30, "expected a count, a whole number"),
    ],
)
def test_whole_numbers_that_do_not_fit(tmp_path: Path, text: str, sentence: str) -> None:
    with pytest.raises(ProblemError, match=sentence):
        tokens(tmp_path, text).whole("a count")


@pytest.mark.parametrize("place", ["-1", "0.5", "3e9"])
def test_a_place_that_is_none_is_reported_where_it_stands(tmp_path: Path, place: str) -> None:
    found = tokens(tmp_path, f"0 1 2.5\n0 {place} 1")
    with pytest.raises(ProblemError, match=r"a\.dat:2:3: expected entries, each place a whole"):
        found.entries(2, 2, "entries")


def test_a_binary_file_ends_in_a_sentence(tmp_path: Path) -> None:
    file = tmp_path / "a.dat"
    file.write_bytes(bytes(range(256)))
    with pytest.raises(ProblemError, match=r"a\.dat:"):
        Tokens(file).numbers(1, "sizes")
