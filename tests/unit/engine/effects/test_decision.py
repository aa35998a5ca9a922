"""Reasons name a few bodies and pairs, count the rest, and leave out nobody."""

from __future__ import annotations

import re

import pytest
from plain_facts import body_facts, pair_facts

from lavendersim.engine.effects.decision import by_pair, named


@pytest.mark.parametrize("count", range(1, 8))
def test_three_names_are_listed_and_of_more_two_and_the_number_of_others(count: int) -> None:
    names = [f"box_{k}" for k in range(count)]
    text = named(names)
    listed = [name for name in names if re.search(rf"\b{name}\b", text)]
    more = re.search(r"and (\d+) more", text)
    assert len(listed) + (int(more[1]) if more else 0) == count
    assert len(listed) == (count if count <= 3 else 2)


@pytest.mark.parametrize("telling", range(6))
@pytest.mark.parametrize("silent", range(4))
def test_pairs_that_have_something_to_tell_come_first_and_all_are_counted(telling, silent) -> None:
    pairs = [pair_facts("floor", f"dull{k}") for k in range(silent)]
    pairs += [pair_facts("floor", f"b{k}", friction=0.5) for k in range(telling)]
    text = by_pair(pairs, lambda pair: "grips" if pair.surface.friction else "")
    spoken = len(re.findall(r": grips", text))
    more = re.search(r"(\d+) more pairs", text)
    assert spoken + (int(more[1]) if more else 0) == telling
    quiet = re.search(r"(\d+) other pairs: none", text)
    assert (int(quiet[1]) if quiet else len(re.findall(r"dull\d: none", text))) == silent
    assert len(text.split("; ")) <= 4
    if telling and silent:
        assert text.index("grips") < text.index("none")


def test_a_body_has_the_forms_that_events_give_it_in_order() -> None:
    assert body_facts("b", config=1, later=(2, 3)).forms == (1, 2, 3)


def test_a_pair_resists_turning_by_torsion_or_rolling() -> None:
    assert not pair_facts("a", "b", friction=1.0).resists_turning
    assert pair_facts("a", "b", torsional_friction=0.1).resists_turning
    assert pair_facts("a", "b", rolling_friction=0.1).resists_turning
