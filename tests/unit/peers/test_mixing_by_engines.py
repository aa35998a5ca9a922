"""Values of bodies from which an engine's rule of mixing makes lavender's; or which it cannot."""

from __future__ import annotations

from itertools import combinations

import pytest

from lavendersim.cell.mixing import mixed
from lavendersim.cell.surface import Surface
from lavendersim.peers.catalogue import PEERS
from lavendersim.peers.mixing import RULES, Unmixable, harmonic_mean, values_by

LOW, HIGH = Surface(friction=0.2), Surface(friction=0.8)
FLOOR, WALL, BALL, OTHER = (LOW, False), (HIGH, False), (HIGH, True), (LOW, True)


def made_by(rule: str, bodies: list[tuple[Surface, bool]]) -> list[float] | Unmixable:
    return values_by({"friction": rule}, "friction", bodies)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("bodies", [[FLOOR, BALL], [BALL, FLOOR], [FLOOR, WALL, BALL]])
def test_two_bodies_are_mixed_as_lavender_does(
    rule: str, bodies: list[tuple[Surface, bool]]
) -> None:
    """Geometric means of 0.2 and 0.8: 0.4 and 0.8, by every rule, where one body moves. A larger of
    two and a lesser of two leave it to what stays as the others do.
    """
    values = made_by(rule, bodies)
    assert not isinstance(values, Unmixable)
    for a, b in combinations(range(len(bodies)), 2):
        if bodies[a][1] or bodies[b][1]:
            found = RULES[rule].mix(values[a], values[b])
            assert found == pytest.approx(mixed(bodies[a][0], bodies[b][0]).friction, rel=2e-15)


@pytest.mark.parametrize(
    ("rule", "values"),
    [
        ("product", (0.4, 1.0)),
        ("least", (0.4, 0.8)),
        ("mean", (0.0, 0.8)),
        ("harmonic_mean", (4 / 15, 0.8)),
    ],
)
def test_a_floor_makes_up_for_balls_that_meet(rule: str, values: tuple[float, float]) -> None:
    """Two balls of 0.8 meet at 0.8, and a floor of 0.2 at 0.4: the floor gets what makes 0.4 of
    theirs: 0.4 of 0.8 by the least, 0 by the mean, 0.32 / 1.2 by the harmonic one.
    """
    found = made_by(rule, [FLOOR, BALL, BALL])
    assert not isinstance(found, Unmixable)
    if rule != "product":
        assert found == pytest.approx([values[0], values[1], values[1]], rel=1e-15, abs=1e-15)
    for a, b, asked in ((0, 1, 0.4), (0, 2, 0.4), (1, 2, 0.8)):
        assert RULES[rule].mix(found[a], found[b]) == pytest.approx(asked, rel=1e-15)


def test_a_product_leaves_the_floor_what_balls_do_not_have() -> None:
    """Balls of 0.5 meet each other at 0.5, so that each has its root; a floor of 0.8 gives 0.8."""
    ball, floor = Surface(restitution=0.5), Surface(restitution=0.8)
    bodies = [(floor, False), (ball, True), (ball, True)]
    found = values_by({"restitution": "product"}, "restitution", bodies)
    assert found == pytest.approx([0.8 * 2.0**0.5, 0.5**0.5, 0.5**0.5], rel=1e-15)


@pytest.mark.parametrize(("rule", "low", "high"), [("larger", 0.2, 0.8), ("mean", 0.1, 0.9)])
def test_what_no_values_give_names_its_two_bodies(rule: str, low: float, high: float) -> None:
    """The larger of 0.8 and anything is no 0.4; a mean of 0.9 and v is 0.3 for no v above 0."""
    bodies = [(Surface(friction=low), False), *[(Surface(friction=high), True)] * 2]
    required = mixed(bodies[0][0], bodies[1][0]).friction
    assert made_by(rule, bodies) == Unmixable((0, 1), required)


def test_two_bodies_are_named_in_the_order_of_the_scene() -> None:
    found = made_by("larger", [BALL, BALL, FLOOR])
    assert isinstance(found, Unmixable)
    assert found.pair == (0, 2)
    # balls that move and differ: 0.4 of 0.2 and 0.8, and 0.8 of 0.8; two of 0.2 there are none
    assert made_by("least", [OTHER, BALL, BALL]) == [0.4, 0.8, 0.8]


def test_a_harmonic_mean_of_two_zeros_is_zero() -> None:
    assert (harmonic_mean(0.0, 0.0), harmonic_mean(1.0, 0.5)) == (0.0, pytest.approx(2.0 / 3.0))


def test_every_rule_that_is_declared_is_one_and_of_a_key_that_is_obeyed() -> None:
    for peer in PEERS.values():
        assert set(peer.mixing.values()) <= RULES.keys()
        assert peer.mixing.keys() <= peer.surface_keys
