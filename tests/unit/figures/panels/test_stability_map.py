"""How far an axis can go: limits are reached from the safe end, and framed by the default."""

from __future__ import annotations

from fractions import Fraction

import pytest
from swept_pages import LABELS, cell, page
from synthetic import SyntheticCell

BOUND = 1.0
STEPS = (Fraction(1, 60), Fraction(1, 120), Fraction(1, 240))
MAP = LABELS | {
    "kind": "stability_map",
    "axis": "mass",
    "rows": "solver",
    "find": "largest",
    "of": "timestep",
    "measure": "impulse",
    "at_most": BOUND,
}
GOOD, BAD = (0.5, "complete"), (2.0, "complete")
FLOWN, UNKNOWN = (0.5, "diverged: body ball"), (float("nan"), "complete")


def column(mass: int, *outcomes: tuple[float, str]) -> list[SyntheticCell]:
    """Cells of one mass at falling timesteps."""
    return [
        cell({"mass": mass, "solver": "one_way", "timestep": step}, *outcome)
        for step, outcome in zip(STEPS, outcomes, strict=True)
    ]


@pytest.mark.parametrize(
    ("outcomes", "limit"),
    [
        ((GOOD, GOOD, GOOD), "1/60"),
        ((BAD, GOOD, GOOD), "1/120"),
        # What holds beyond a failure holds by luck.
        ((GOOD, BAD, GOOD), "1/240"),
        ((GOOD, GOOD, BAD), "none"),
        ((FLOWN, GOOD, GOOD), "1/120"),
        ((UNKNOWN, GOOD, GOOD), "1/120"),
    ],
)
def test_the_largest_stable_value_is_reached_from_the_smallest(
    outcomes: tuple[tuple[float, str], ...], limit: str
) -> None:
    axes = page(MAP, column(1, *outcomes)).axes[0]
    assert [text.get_text() for text in axes.texts] == [limit]


def test_the_least_value_is_reached_from_the_largest() -> None:
    axes = page(MAP | {"find": "least"}, column(1, GOOD, GOOD, BAD)).axes[0]
    assert [text.get_text() for text in axes.texts] == ["1/120"]


def test_every_cell_of_a_place_must_hold() -> None:
    phases = [
        cell({"mass": 1, "solver": "one_way", "timestep": STEPS[0], "phase": phase}, impulse)
        for phase, impulse in enumerate((0.5, 2.0))
    ]
    assert [text.get_text() for text in page(MAP, phases).axes[0].texts] == ["none"]


def test_a_map_names_its_places_and_frames_the_default() -> None:
    cells = [*column(1, GOOD, GOOD, GOOD), *column(10, BAD, BAD, GOOD)]
    axes = page(MAP | {"default": {"mass": 10}}, cells).axes[0]
    assert [label.get_text() for label in axes.get_xticklabels()] == ["1", "10"]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["one way"]
    assert [text.get_text() for text in axes.texts] == ["1/60", "1/240"]
    frames = [patch for patch in axes.patches if not patch.get_fill()]
    assert [(frame.get_x(), frame.get_width()) for frame in frames] == [(0.5, 1)]
