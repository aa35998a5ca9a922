"""What an effect needs, all the way down, and which effects a key of the config chooses."""

from __future__ import annotations

import pytest

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import BY_NAME
from lavendersim.scene.laws import choice, is_law, needs


@pytest.mark.parametrize("name", sorted(BY_NAME))
def test_needs_are_closed_and_do_not_come_back(name: str) -> None:
    found = needs(name)
    assert len(found) == len(set(found))
    assert name not in found
    for one in found:
        assert set(BY_NAME[one].needs) <= set(found)


def test_a_shape_pair_needs_nothing_and_is_no_law() -> None:
    for pair in SHAPE_PAIRS:
        assert needs(pair) == ()
        assert not is_law(pair)


def test_a_law_has_a_key_and_a_coefficients_effect_has_none() -> None:
    laws = {name for name in BY_NAME if is_law(name)}
    assert {"impact_order", "midpoint"} <= laws
    for name in laws:
        assert choice(name) == BY_NAME[name].chosen_by
    assert not is_law("drag")
    with pytest.raises(ValueError, match="no key of a config chooses drag"):
        choice("drag")
