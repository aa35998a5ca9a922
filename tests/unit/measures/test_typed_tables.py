"""Plain data as the dataclass that it is of, and the place of what does not fit."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from lavendersim.measures.typed_tables import plain, read_as


@dataclass(frozen=True)
class Inner:
    number: float | None


@dataclass(frozen=True)
class Outer:
    name: str
    rows: list[Inner]


def test_what_is_written_is_read_again() -> None:
    outer = Outer("a", [Inner(0.1), Inner(None)])
    assert plain(outer) == {"name": "a", "rows": [{"number": 0.1}, {"number": None}]}
    assert read_as(Outer, plain(outer)) == outer


def test_what_a_later_version_adds_is_left_out() -> None:
    assert read_as(Inner, {"number": 1.0, "more": 2.0}) == Inner(1.0)


@pytest.mark.parametrize(
    ("data", "place"),
    [
        ({"name": "a", "rows": [{"number": 1.0}, {"number": "one"}]}, r"^rows\.1\.number: "),
        ({"name": "a"}, "^rows: field required$"),
        ({"name": 1, "rows": []}, "^name: "),
        ([], "^: "),
    ],
)
def test_what_does_not_fit_is_refused_with_its_place(data: object, place: str) -> None:
    with pytest.raises(ValueError, match=place):
        read_as(Outer, data)
