"""Surfaces: defaults without effect, and what is written of a pair in place of what they mix to."""

from __future__ import annotations

from lavendersim.cell.mixing import mixed
from lavendersim.cell.surface import PairedSurface, PairProperties, Partner, Surface
from lavendersim.engine.effects import SURFACE_KEYS


def test_a_surface_has_every_property_that_an_effect_declares_at_its_default() -> None:
    surface = Surface()
    assert set(Surface.model_fields) == {key.name for key in SURFACE_KEYS}
    assert all(getattr(surface, key.name) == key.default for key in SURFACE_KEYS)
    assert list(Surface.model_fields)[:2] == ["restitution", "compliance"]


def test_of_a_pair_nothing_is_written_unless_it_is() -> None:
    assert set(PairProperties().model_dump().values()) == {None}
    assert Partner(surface="ice", friction=0.1).model_dump() == {"surface": "ice", "friction": 0.1}


def test_the_partner_of_a_name_or_none() -> None:
    ice = Partner(surface="ice", friction=0.05)
    wood = PairedSurface(name="wood", friction=0.5, partners=(ice,))
    assert wood.with_partner("ice") == ice
    assert wood.with_partner("wood") is None


def test_what_is_written_of_a_pair_stands_in_place_of_the_mean_in_both_orders() -> None:
    wood = PairedSurface(
        name="wood", friction=0.4, partners=(Partner(surface="ice", friction=0.05),)
    )
    ice = PairedSurface(
        name="ice", friction=0.1, partners=(Partner(surface="wood", friction=0.05),)
    )
    assert mixed(wood, ice).friction == mixed(ice, wood).friction == 0.05
    assert mixed(wood, Surface(friction=0.1)).friction == 0.2  # sqrt(0.04)
