"""Axes of a sweep as written: their values in exact numbers, and one way to say each thing."""

from __future__ import annotations

from fractions import Fraction

import pytest

from lavendersim.experiment.models.axis import axis_paths, axis_values
from lavendersim.experiment.text.node import Node
from lavendersim.experiment.text.parse import parse
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.scalars import exact
from tests.marked_config import assert_refused, config

MASS = "path: scene.bodies.ball.mass"


def axis(text: str) -> Node:
    root = parse(text.encode(), Report(""))
    assert root is not None
    return root


def exact_values(text: str) -> list[Fraction]:
    numbers = [node.number for node in axis_values(axis(text))]
    return [exact(number) for number in numbers if number is not None]


def test_steps_of_a_range_are_equal_and_both_ends_are_values() -> None:
    """In ratios: thirds and sixtieths are no binary numbers, and are exact all the same."""
    values = exact_values("range: {from: 1/60, to: 1, steps: 177}")
    assert values == [Fraction(1, 60) + k * Fraction(1, 180) for k in range(178)]


def test_geometric_values_have_one_exact_factor_where_it_is_a_ratio() -> None:
    values = exact_values("geometric: {from: 1/60, to: 1/480, steps: 3}")
    assert values == [Fraction(1, count) for count in (60, 120, 240, 480)]
    assert exact_values("geometric: {from: -27, to: -8, steps: 3}") == [-27, -18, -12, -8]


def test_other_geometric_values_keep_twelve_digits_and_exact_ends() -> None:
    """10^(1/3) and its square: the relative error is half a unit of the twelfth digit at most."""
    first, second, third, last = exact_values("geometric: {from: 1/3, to: 10/3, steps: 3}")
    assert (first, last) == (Fraction(1, 3), Fraction(10, 3))
    for value, power in ((second, 1), (third, 2)):
        assert abs(float(3 * value) ** 3 / 10**power - 1.0) < 3 * 5e-12


@pytest.mark.parametrize("steps", ["0", "1.5", "100000", "many", "null"])
def test_what_is_refused_has_no_values(steps: str) -> None:
    assert exact_values(f"range: {{from: 1, to: 2, steps: {steps}}}") == []


def test_the_first_of_paths_with_own_values_names_the_cells() -> None:
    own = "paths: {scene.bodies.a.mass: [1, 8], scene.bodies.a.shape.radius: [0.1, 0.2]}"
    assert exact_values(own) == [1, 8]
    assert axis_paths(axis(own)) == ["scene.bodies.a.mass", "scene.bodies.a.shape.radius"]
    assert axis_paths(axis("{path: a, paths: [b, c]}")) == ["a", "b", "c"]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("range: {from: 2, to: §2, steps: 1}", "to: expected another number than from, found 2"),
        (
            "geometric: §{from: -1, to: 2, steps: 1}",
            "geometric: from and to: expected two numbers above 0, or two below, found -1 and 2",
        ),
        (
            "values: [1], §range: {from: 1, to: 2, steps: 1}",
            "sweep.m specifies values and range; keep one",
        ),
        (
            "range: {from: 1, to: 2, steps: 1}, §values: [1]",
            "sweep.m specifies values and range; keep one",
        ),
    ],
)
def test_ends_and_sources_that_give_no_values_are_refused(words: str, sentence: str) -> None:
    assert_refused(config(sweep=f"{{m: {{{MASS}, {words}}}}}"), sentence)


def test_an_axis_needs_a_path_and_values() -> None:
    assert_refused(
        config(sweep="{m: §{values: [1, 2]}}"),
        'missing key "path" in sweep.m: such as scene.bodies.ball.mass or numerics.timestep',
    )
    assert_refused(
        config(sweep=f"{{m: §{{{MASS}}}}}"),
        'missing key "values" in sweep.m: a list, or range or geometric: {from, to, steps}',
    )
    lists = "scene.bodies.ball.mass: [1, 2], scene.bodies.ball.shape.radius: §[0.1]"
    assert_refused(
        config(sweep=f"{{m: {{paths: {{{lists}}}}}}}"),
        "paths: expected 2 values as of the first, found 1",
    )
