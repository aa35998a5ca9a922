"""A structure of an engine: effects are a sorted set, and its name tells it from every other."""

from __future__ import annotations

from lavendersim.engine.spec import Spec


def test_effects_are_added_and_taken_away_as_from_a_set() -> None:
    spec = Spec(("friction",), ("box_plane",))
    more = spec.including("rotation", "cohesion", "friction")
    assert more.effects == ("cohesion", "friction", "rotation")
    assert more.shape_pairs == spec.shape_pairs
    assert more.without("rotation", "cohesion", "gravity") == spec
    assert spec.effects == ("friction",)  # neither changes the spec itself


def test_it_has_what_it_was_given() -> None:
    spec = Spec(("friction",), ("box_plane",))
    assert spec.has("friction")
    assert not spec.has("rotation")
    assert spec.collides("box_plane")
    assert not spec.collides("box_box")


def test_every_choice_has_a_part_in_the_name() -> None:
    """Two engines of different code never share a file of kernels."""
    spec = Spec(("friction",), ("box_plane",))
    others = [
        spec.including("rotation"), spec._replace(shape_pairs=()), spec._replace(solver="jacobi"),
        spec._replace(tolerance=True), spec._replace(friction_cone="pyramid"),
        spec._replace(operator="matrix"), spec._replace(over_relaxation=True),
        spec._replace(order="random"),
    ]  # fmt: skip
    names = {each.digest() for each in (spec, *others)}
    assert len(names) == len(others) + 1 == len(Spec._fields) + 1
    assert spec.digest() == Spec(("friction",), ("box_plane",)).digest()
