"""What a variant reports is what its engine reports, unless it says otherwise."""

from __future__ import annotations

from lavendersim.peers.catalogue import PEERS


def test_a_variant_tells_what_its_engine_does_unless_it_says_so() -> None:
    peer = PEERS["mujoco"]
    assert peer.reports("mujoco-stiff") == peer.reported
    assert peer.reports("mujoco-rk4") == ()


def test_every_engine_states_its_law_and_whether_it_repeats() -> None:
    assert all(peer.law and peer.repeats and peer.tried for peer in PEERS.values())
    assert all(peer.iterations and peer.capacity for peer in PEERS.values())


def test_what_is_swept_are_variants_and_settings_that_there_are_defaults_among_them() -> None:
    for name, peer in PEERS.items():
        settings = {one.name for one in peer.settings}
        assert name in {one.variant for one in peer.swept}
        for one in peer.swept:
            assert one.variant in peer.variants
            assert one.values.keys() <= settings
