"""Arrangements as written: spacing or gap, and as many spacings as there are neighbours."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text
from tests.marked_config import FLOOR, assert_refused, config, refusals, scene

BODY = "body: {shape: {kind: sphere, radius: 0.1}, mass: 1}"


def with_arrangement(words: str) -> str:
    return config(scene=scene(FLOOR, arrangements=f"{{pile: {{{words}, {BODY}}}}}"))


@pytest.mark.parametrize(
    ("words", "count"),
    [
        ("kind: tower, count: 5", 5),
        ("kind: pyramid, base_count: 4", 4 + 3 + 2 + 1),
        ("kind: grid, counts: [2, 3, 4], spacing: [1, 1, 1]", 2 * 3 * 4),
        ("kind: row, count: 3, spacing: [1, 2]", 3),
        ("kind: ring, count: 7, radius: 2", 7),
        ("kind: rack, rows: 5", 15),
    ],
)
def test_each_kind_has_as_many_bodies_as_its_form_says(words: str, count: int) -> None:
    cell = load_experiment_text(with_arrangement(words), "a.yaml").cells()[0]
    assert len(cell.config.scene.bodies) == 1 + count


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (
            "kind: row, count: 3, gap: 0, §spacing: 1",
            "scene.arrangements.pile specifies both gap and spacing; keep one",
        ),
        (
            "kind: row, spacing: 1, count: 3, §gap: 0.1",
            "scene.arrangements.pile specifies both gap and spacing; keep one",
        ),
        (
            "kind: row, count: 4, spacing: §[1, 2]",
            "spacing: expected 3 numbers, one for each two neighbours, found 2",
        ),
        ("kind: tower, count: §0", "count: expected a whole number from 1 to 100000, found 0"),
        (
            "kind: grid, counts: [1, 1, 1], spacing: [1, §0, 1]",
            "spacing[1]: expected a number above 0 [m], found 0",
        ),
    ],
)
def test_what_no_arrangement_can_be_is_refused_at_its_place(words: str, sentence: str) -> None:
    assert_refused(with_arrangement(words), sentence)


def test_first_takes_the_rest_from_body() -> None:
    words = f"kind: row, count: 2, spacing: 1, first: {{mass: 3}}, {BODY}"
    text = config(scene=scene(FLOOR, arrangements=f"{{pile: {{{words}}}}}"))
    assert refusals(text) == []
    bodies = load_experiment_text(text, "a.yaml").cells()[0].config.scene.bodies
    assert [bodies[name].mass for name in ("pile_1", "pile_2")] == [3.0, 1.0]
    assert bodies["pile_1"].shape == bodies["pile_2"].shape
