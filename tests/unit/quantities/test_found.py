"""Values and names in the words of a message."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from lavendersim.quantities.found import LONGEST_QUOTE, MOST_NAMES, found, near, nearest, quoted

SOLVERS = ("projected_gauss_seidel", "jacobi", "adaptive", "stabilisation_gain")


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (None, "nothing"),
        (True, "true"),
        (0.5, "0.5"),
        ("half", 'the text "half"'),
        ([1, 2], "a list of 2"),
        ((), "an empty list"),
        ({}, "a mapping"),
    ],
)
def test_a_value_in_words_that_a_person_recognises(value: Any, words: str) -> None:
    assert found(value) == words


def test_a_quoted_text_is_one_line_and_no_longer_than_can_be_read() -> None:
    assert quoted("two\n  lines") == '"two lines"'
    long = quoted("x" * 1000)
    assert len(long) == LONGEST_QUOTE + 2
    assert long.endswith('..."')
    assert quoted(Fraction(1, 3)) == '"1/3"'


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("pgs", "projected_gauss_seidel"),  # first letters
        ("Jacoby", "jacobi"),
        ("gain", "stabilisation_gain"),  # a word of it
        ("zzz", None),
    ],
)
def test_the_name_that_was_meant(written: str, meant: str | None) -> None:
    assert near(written, SOLVERS) == meant


def test_without_a_near_name_all_are_listed_each_once() -> None:
    assert nearest("zzz", ["one", "two", "one"]) == "; valid here: one, two"
    assert nearest("zzz", []) == ""


def test_names_beyond_those_that_are_listed_are_counted() -> None:
    many = nearest("zzz", [f"name{k}" for k in range(MOST_NAMES + 3)])
    assert many.endswith(f"name{MOST_NAMES - 1} and 3 more")


def test_half_of_a_quantity_is_twice_as_much_of_the_whole() -> None:
    # Who writes `half_size` gave half of what `size` is.
    assert nearest("half_size", ["size"]) == '; did you mean "size", twice as much?'
    assert nearest("siez", ["size"]) == '; did you mean "size"?'
    assert nearest("diameter", ["radius"]) == '; did you mean "radius", half as much?'


def test_a_word_of_other_programs_has_the_name_here_where_that_is_valid() -> None:
    assert near("dt", ["duration", "timestep"]) == "timestep"
    assert near("ball", ["plane", "sphere", "box"]) == "sphere"
    assert near("mu", ["compliance", "restitution"]) is None
    assert near("ball", ["bell", "sphere_of_influence"]) == "bell"  # a body, misspelt
    assert near("z", ["energy", "position_x", "position_z", "velocity_z"]) == "position_z"
