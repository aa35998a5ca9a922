"""The keys `engine` and `engines`, and their schema for editors."""

from __future__ import annotations

from lavendersim.experiment.models.engines import Engines
from lavendersim.experiment.models.experiment import ExperimentConfig
from lavendersim.peers.catalogue import NAMES, PEERS


def test_the_schema_lists_every_engine_and_every_setting() -> None:
    schema = ExperimentConfig.model_json_schema()
    assert schema["properties"]["engine"]["enum"] == list(NAMES)
    settings = schema["$defs"]["MuJoCoSettings"]["properties"]
    assert list(settings) == [one.name for one in PEERS["mujoco"].settings]


def test_nothing_is_set_by_default() -> None:
    assert Engines().model_dump() == dict.fromkeys(PEERS)
