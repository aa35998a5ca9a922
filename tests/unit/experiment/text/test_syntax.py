"""Syntax errors are said as what was meant, where the mistake is."""

from __future__ import annotations

import pytest
import yaml

from lavendersim.experiment.text.node import Mark
from lavendersim.experiment.text.syntax import MOST_TABS, describe


def described(text: str) -> list[tuple[Mark, str]]:
    """Return what is said of a text that PyYAML refuses."""
    try:
        list(yaml.parse(text, yaml.SafeLoader))
    except yaml.MarkedYAMLError as error:
        return list(describe(error, text))
    raise AssertionError("it is YAML")


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("a: b: c\n", 1, 'a ":" too many'),
        ('a: 1\nb: "open\nc: 2\n', 2, "a quote that is not closed"),
        ("a: 1\nb: [1, 2\nc: 3\n", 2, 'a "[" that is not closed'),
        ("a: {b: 1\nc: 2\n", 1, 'a "{" that is not closed'),
        ("a: 1\n  b: 2\n", 2, 'a ":" too many'),
        ("a: @b\n", 1, "this character cannot start a value"),
        ('a: "\\q"\n', 1, "an unknown escape"),
    ],
)
def test_a_mistake_is_said_where_it_is(text: str, line: int, words: str) -> None:
    ((mark, sentence),) = described(text)
    assert sentence.startswith(words)
    assert mark.line == line


def test_every_line_that_is_indented_with_a_tab_is_named() -> None:
    found = described("a:\n\tb: 1\n \tc: 2\n")
    assert [mark for mark, _ in found] == [Mark(2, 1), Mark(3, 2)]
    assert len(described("a:\n" + "\tb: 1\n" * (MOST_TABS + 5))) == MOST_TABS
