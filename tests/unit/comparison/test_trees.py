"""Differences of plain data, by path."""

from __future__ import annotations

import math
from typing import Any

import pytest

from lavendersim.comparison.trees import ABSENT, differences


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        ({"x": {"y": 1}}, {"x": {"y": 2}}, [("x.y", 1, 2)]),
        ({"x": 0.25}, {"x": 1 / 4}, []),
        ({"x": 1}, {"x": True}, [("x", 1, True)]),
        ({"x": math.nan}, {"x": math.nan}, []),
        ({"x": [1, 2]}, {"x": (1, 3)}, [("x", [1, 2], (1, 3))]),
        ({"x": [{"k": 1}]}, {"x": [{"k": 1}, {"k": 2}]}, [("x.1", ABSENT, {"k": 2})]),
        ({"x": 1, "y": 2}, {"y": 2, "z": 3}, [("x", 1, ABSENT), ("z", ABSENT, 3)]),
        ({"x": {"y": 1}}, {"x": "chapter"}, [("x", {"y": 1}, "chapter")]),
    ],
)
def test_leaves_that_differ_are_named_by_their_path(a: Any, b: Any, expected: list[Any]) -> None:
    assert [tuple(one) for one in differences(a, b)] == expected
