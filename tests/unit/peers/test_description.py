"""Values of bodies from which an engine's rule of mixing makes lavender's."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.peers.description import Scene, harmonic_mean
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


def test_a_product_of_roots_is_the_geometric_mean() -> None:
    found = scene(0.2, 0.0, 0.8, 0.0)
    mu = found.by_product("friction")
    for a, b in found.pairs():
        assert mu[a.row] * mu[b.row] == pytest.approx(found.of_pair("friction", a, b), rel=1e-15)


def test_a_product_of_equal_restitutions_is_their_larger() -> None:
    found = scene(0.0, 0.5, 0.0, 0.5)
    e = found.by_product("restitution")
    assert [e[a.row] * e[b.row] for a, b in found.pairs()] == pytest.approx([0.5] * 5, rel=1e-15)


def test_what_a_rule_cannot_make_is_refused_and_not_replaced() -> None:
    """Larger of 0.25 and 0.5 by products: a a = 0.5, a f = 0.5, so f = a: no other f mixes so, and
    a floor of lower friction than that of two balls is none by the lesser of 0.4 and 0.8.
    """
    with pytest.raises(CannotRun, match="no such friction"):
        scene(0.9, 0.0, 0.4, 0.0).by_least("friction")


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


def test_means_are_those_that_a_resting_body_completes() -> None:
    """Two floors that differ: the ball has nothing to say, each floor twice its mixture, or
    v / (2 - v) beside 1.
    """
    text = TWO.format(0.2, 0.0, 0.8, 0.0).replace("surface: ball}}", "surface: ball}")
    text = "\n".join(line for line in text.splitlines() if "    b:" not in line)
    text = text.replace("forces: [{body: b", "forces: [{body: a")
    found = Scene(load_experiment_text(text, "one.yaml").cells()[0].config)
    floor, wall, ball = (mu for mu in found.by_mean("friction"))
    assert [0.5 * (one + ball) for one in (floor, wall)] == pytest.approx([0.4, 0.8], rel=1e-15)
    floor, wall, ball = (mu for mu in found.by_harmonic_mean("friction"))
    mixed = [harmonic_mean(one, ball) for one in (floor, wall)]
    assert mixed == pytest.approx([0.4, 0.8], rel=2e-15)
    assert harmonic_mean(0.0, 0.0) == 0.0
    asked = found.mixed("friction")
    assert asked[0, 2] == asked[2, 0] == pytest.approx(0.4)
    assert asked[1, 2] == pytest.approx(0.8)


def test_a_rule_that_three_surfaces_cannot_follow_is_refused() -> None:
    """Balls that meet each other leave nothing to the floors."""
    with pytest.raises(CannotRun, match="no such friction"):
        scene(0.2, 0.0, 0.8, 0.0).by_mean("friction")
