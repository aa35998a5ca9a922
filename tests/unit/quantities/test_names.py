"""Names: which may be given to something new, and which must be known to the file."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import TypeAdapter, ValidationError

from lavendersim.quantities.names import BodyName, ConstantName, NewName


class File:
    """A file with one body."""

    def refusal_of(self, kind: str, name: str) -> str | None:
        """Return why a name is none of a kind."""
        return None if (kind, name) == ("body", "ball") else f"no {kind} is called {name}"


def valid(annotation: Any, name: str, context: Any = None) -> bool:
    """Tell whether a name is taken."""
    try:
        return TypeAdapter(annotation).validate_python(name, context=context) == name
    except ValidationError:
        return False


def test_a_body_must_be_one_of_the_file() -> None:
    assert valid(BodyName, "ball", File())
    assert not valid(BodyName, "bell", File())
    with pytest.raises(ValidationError, match="no body is called bell"):
        TypeAdapter(BodyName).validate_python("bell", context=File())


def test_without_a_file_any_name_may_be_one() -> None:
    assert valid(BodyName, "bell")


@pytest.mark.parametrize("name", ["a", "_a1", "low_ball", "x" * 64])
def test_names_that_both_take(name: str) -> None:
    assert valid(NewName, name)
    assert valid(ConstantName, name)


@pytest.mark.parametrize("name", ["", "1a", "a.b", "a b", "x" * 65, "é"])
def test_names_that_neither_takes(name: str) -> None:
    assert not valid(NewName, name)
    assert not valid(ConstantName, name)


def test_a_constant_has_no_minus_which_subtracts() -> None:
    assert valid(NewName, "low-ball")
    assert not valid(ConstantName, "low-ball")
