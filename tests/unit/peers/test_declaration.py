"""What a variant reports is what its engine reports, unless it says otherwise."""

from __future__ import annotations

import pytest
from pydantic import TypeAdapter, ValidationError

from lavendersim.peers.catalogue import PEERS
from lavendersim.peers.declaration import Count


def test_a_variant_tells_what_its_engine_does_unless_it_says_so() -> None:
    peer = PEERS["mujoco"]
    assert peer.reports("mujoco-stiff") == peer.reported
    assert peer.reports("mujoco-rk4") == ()


def test_every_engine_states_its_law_and_whether_it_repeats() -> None:
    assert all(peer.law and peer.repeats and peer.tried for peer in PEERS.values())
    assert all(peer.iterations and peer.capacity for peer in PEERS.values())


def test_own_defaults_are_a_variant_and_tuned_ones_have_their_reason() -> None:
    for name, peer in PEERS.items():
        assert not peer.variants[name].settings
        tuned = {variant: one for variant, one in peer.variants.items() if variant != name}
        assert tuned
        assert all(one.settings and one.doc for one in tuned.values())


def test_what_is_swept_are_variants_and_settings_that_there_are_defaults_among_them() -> None:
    for name, peer in PEERS.items():
        settings = {one.name for one in peer.settings}
        assert name in {one.variant for one in peer.swept}
        # its own defaults are one of its swept settings: what it has of what they vary
        shared = [one.values for one in peer.swept if one.variant == name]
        assert {} in shared or any(
            values.keys() == peer.own.keys()
            and all(peer.own[key] in many for key, many in values.items())
            for values in shared
        )
        for one in peer.swept:
            assert one.variant in peer.variants
            assert one.values.keys() <= settings


def test_a_count_is_what_an_engine_can_hold() -> None:
    """MuJoCo refused 99999999999 iterations by a sentence of its own, after the run had begun."""
    count = TypeAdapter(Count)
    assert count.validate_python(2**31 - 1) == 2**31 - 1
    for wrong in (0, 2**31):
        with pytest.raises(ValidationError, match="a whole number from 1 to 2147483647"):
            count.validate_python(wrong)
