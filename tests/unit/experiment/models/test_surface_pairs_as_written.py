"""Which surfaces a pair names: their order says nothing, and one pair of the same two is enough."""

from __future__ import annotations

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.models.surface_pairs import between, paired
from lavendersim.experiment.text.parse import parse
from lavendersim.experiment.text.report import Report

SCENE = """
scene:
  surfaces: {{wood: {{friction: 0.5}}, ice: {{friction: 0.1}}}}
  surface_pairs:
{pairs}
  bodies: {{ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, position: [0, 0, 1]}}}}
duration: 0.1
"""
ONE = "    one: {between: [wood, ice], friction: 0.05}\n"


def refused(pairs: str) -> list[str]:
    """Return the sentences with which a config of these pairs is refused."""
    with pytest.raises(ConfigError) as error:
        load_experiment_text(SCENE.format(pairs=pairs), "a.yaml")
    return [one.message for one in error.value.defects]


def test_names_are_sorted_and_a_surface_is_found_in_its_pair() -> None:
    root = parse(SCENE.format(pairs=ONE).encode(), Report("a.yaml"))
    assert root is not None
    assert between(root.get("scene", "surface_pairs", "one")) == ("ice", "wood")
    assert paired(root, "wood") == "one"
    assert paired(root, "iron") is None


def test_the_same_two_in_another_order_are_refused() -> None:
    (said,) = refused(ONE + "    two: {between: [ice, wood], friction: 0.1}\n")
    assert said == 'between: "ice" and "wood" stand in one; keep one pair'


def test_a_pair_that_says_nothing_is_refused() -> None:
    (said,) = refused("    one: {between: [wood, ice]}\n")
    assert said == "scene.surface_pairs.one has no property; expected one such as friction"
