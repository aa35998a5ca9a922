"""A cell as adapters read it: surfaces, forces, values of bodies by an engine's rule."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.peers.catalogue import PEERS
from lavendersim.peers.description import Scene
from lavendersim.peers.world import CannotRun

TWO = """
scene:
  surfaces:
    floor: {{friction: {0}, restitution: {1}}}
    ball: {{friction: {2}, restitution: {3}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: floor}}
    wall: {{shape: {{kind: plane, normal: [1, 0, 0], offset: -9}}, surface: ball}}
    a: {{shape: {{kind: sphere, radius: 1}}, mass: 1, position: [0, 0, 2], surface: ball}}
    b: {{shape: {{kind: sphere, radius: 1}}, mass: 1, position: [4, 0, 2], surface: ball}}
  forces: [{{body: b, from: 0.1, to: 0.2, force: [1, 2, 3]}}]
numerics: {{timestep: 1/10}}
duration: 1
"""


def scene(*values: float) -> Scene:
    text = TWO.format(*values)
    return Scene(load_experiment_text(text, "two.yaml").cells()[0].config)


def test_values_are_by_the_rule_that_an_engine_declares() -> None:
    """Bullet multiplies: 0.4 of 0.2 and 0.8."""
    found = scene(0.2, 0.0, 0.8, 0.0)
    mu = found.values("friction", PEERS["bullet"])
    for a, b in found.pairs():
        assert mu[a.row] * mu[b.row] == pytest.approx(found.of_pair("friction", a, b), rel=1e-15)


def test_what_a_rule_cannot_make_is_refused_and_not_replaced() -> None:
    """A mean of 0.9, that balls have, and a friction above 0 is not their 0.3 on the floor."""
    with pytest.raises(CannotRun, match="no such friction"):
        scene(0.1, 0.0, 0.9, 0.0).values("friction", PEERS["physx"])


def test_who_stays_says_what_holds_in_its_contacts() -> None:
    found = scene(0.2, 0.5, 0.8, 0.1)
    first = found.by_first(("friction", "restitution"))
    assert first is not None
    values, differ = first
    assert differ
    for a, b in found.pairs():
        says = values[a.row] if not a.moves else values[b.row]
        required = [found.of_pair(key, a, b) for key in ("friction", "restitution")]
        assert list(says) == required


def test_a_force_acts_in_steps_that_start_within_its_time() -> None:
    """Steps of 0.1 s: from 0.1 to 0.2 s that is the second alone; on b, the second that moves."""
    found = scene(0.2, 0.0, 0.8, 0.0)
    assert [found.loads(step) is None for step in (1, 2, 3)] == [True, False, True]
    np.testing.assert_array_equal(found.loads(2), [[0.0] * 6, [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]])


def test_coefficients_of_every_two_bodies_are_those_of_their_surfaces() -> None:
    asked = scene(0.2, 0.0, 0.8, 0.0).mixed("friction")
    assert asked[0, 2] == asked[2, 0] == pytest.approx(0.4)
    assert asked[1, 2] == pytest.approx(0.8)
