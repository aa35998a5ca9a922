"""A deliberate error is refused where the numerics have no place for it."""

from __future__ import annotations

import pytest

from tests.marked_config import assert_refused, config, refusals

MISTAKE = "{mistake: capture_in_sweeps}"
WHY = {
    "solver": "is a mistake in the loop of projected_gauss_seidel; "
    "expected solver: projected_gauss_seidel",
    "impacts": "is a mistake of captured restitution; expected impacts: captured",
}


def test_a_mistake_has_its_place_in_the_chapters_loop_alone() -> None:
    assert refusals(config(numerics="chapter", study=MISTAKE)) == []
    assert refusals(config(numerics="default", study="{mistake: none}")) == []


@pytest.mark.parametrize(("key", "value"), [("solver", "jacobi"), ("impacts", "in_order")])
def test_other_numerics_are_refused_at_the_later_of_the_two(key: str, value: str) -> None:
    sentence = f"mistake: capture_in_sweeps {WHY[key]}, found {value}"
    numerics = f"{{preset: chapter, {key}: {value}}}"
    last = config(numerics=numerics, study=MISTAKE.replace(" c", " §c"))
    assert_refused(last, sentence)
    first = config(study=MISTAKE, numerics=numerics.replace(f"{key}: ", f"{key}: §"))
    assert_refused(first, sentence)
