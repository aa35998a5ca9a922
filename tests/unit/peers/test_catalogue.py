"""Names of engines: which are meant, what is wrong with one."""

from __future__ import annotations

import pytest

from lavendersim.errors import UsageError
from lavendersim.peers import catalogue


def test_a_misspelt_engine_gets_the_nearest_and_what_is_installed() -> None:
    with pytest.raises(UsageError) as refused:
        catalogue.chosen(["lavender,mujco"])
    assert str(refused.value).startswith('no engine is called "mujco" (installed here: lavender')
    assert str(refused.value).endswith('; did you mean "mujoco"?')


def test_one_that_is_not_installed_gets_the_command(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(catalogue, "installed_version", lambda name: "")
    with pytest.raises(
        UsageError,
        match=r"^MuJoCo is not installed: `pip install mujoco` .* installed here: lavender$",
    ):
        catalogue.chosen(["mujoco-stiff"])
    assert catalogue.chosen(["all"]) == ("lavender",)


def test_one_engine_is_a_value_and_several_are_an_axis() -> None:
    assert catalogue.overrides_of(["mujoco"]) == ["set engine=mujoco"]
    assert catalogue.overrides_of(["lavender", "mujoco"]) == [
        "sweep engine=engine:[lavender, mujoco]"
    ]
    assert catalogue.chosen(["lavender, lavender"]) == ("lavender",)


def test_every_variant_begins_with_its_engine() -> None:
    for name, peer in catalogue.PEERS.items():
        assert next(iter(peer.variants)) == name
        assert all(catalogue.peer_of(variant) is peer for variant in peer.variants)
        known = {setting.name for setting in peer.settings}
        assert all(variant.settings.keys() <= known for variant in peer.variants.values())


def test_a_version_that_was_never_tried_is_reported_once(monkeypatch: pytest.MonkeyPatch) -> None:
    versions = {"mujoco": "99.1", "rapier": "", "bullet": catalogue.PEERS["bullet"].tried[0]}
    monkeypatch.setattr(catalogue, "installed_version", versions.__getitem__)
    names = ["lavender", "mujoco", "mujoco-stiff", "rapier", "bullet"]
    (sentence,) = catalogue.untried(names)
    tried = ", ".join(catalogue.PEERS["mujoco"].tried)
    assert (
        sentence == f"MuJoCo of mujoco 99.1 was never tried with lavender; tests have run {tried}"
    )
