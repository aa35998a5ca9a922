"""Values of bodies from which an engine's rule of mixing makes lavender's."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.experiment import load_experiment_text
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
