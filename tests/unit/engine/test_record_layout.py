"""A record has its base fields, those of the effects of its engine, and no others."""

from __future__ import annotations

import pytest

from lavendersim.engine import record_layout
from lavendersim.engine.effects import EFFECTS
from lavendersim.engine.records import BODY, CONTACT, ORIENTED_BODY, PAIR, PARAMETERS, VELOCITY
from lavendersim.engine.solvers.catalogue import SOLVERS
from lavendersim.engine.spec import Spec

BASE = {"body": BODY, "velocity": VELOCITY, "pair": PAIR, "contact": CONTACT}
MADE = {
    "body": record_layout.body_dtype,
    "velocity": record_layout.velocity_dtype,
    "pair": record_layout.pair_dtype,
    "contact": record_layout.contact_dtype,
}


def names(fields) -> set[str]:
    return {name for name, _ in fields}


@pytest.mark.parametrize("record", MADE)
@pytest.mark.parametrize("effect", EFFECTS, ids=lambda effect: effect.name)
def test_an_effect_brings_its_own_fields_and_nobody_elses(record: str, effect) -> None:
    spec = Spec((effect.name,), (), "jacobi")
    expected = names(BASE[record]) | names(getattr(effect.fields, record))
    if record == "contact":
        expected |= names(SOLVERS["jacobi"].contact_fields)
        if effect.fields.contact_with:
            expected |= names(effect.fields.contact_with(spec))
    assert set(MADE[record](spec).names) == expected


def test_bodies_are_oriented_and_have_a_hull_only_where_a_shape_asks() -> None:
    oriented, bare = names(ORIENTED_BODY), names(BODY)
    for pairs, expected in (
        (("sphere_plane", "sphere_sphere"), bare),
        (("box_plane",), bare | oriented),
        (("hull_plane",), bare | oriented | {"hull"}),
    ):
        assert set(record_layout.body_dtype(Spec((), pairs)).names) == expected


def test_parameters_are_the_same_in_every_engine_and_one() -> None:
    found = record_layout.allocate_parameters()
    own = [field for effect in EFFECTS for field in effect.fields.parameters]
    assert found.shape == (1,)
    assert set(found.dtype.names) == names(PARAMETERS) | names(own)


@pytest.mark.parametrize("record", ["bodies", "velocities", "pairs", "links", "drives"])
def test_tables_begin_with_zeros(record: str) -> None:
    spec = Spec(tuple(sorted(effect.name for effect in EFFECTS)), ("hull_plane",))
    made = getattr(record_layout, f"allocate_{record}")(spec, 3)
    assert made.shape == (3,)
    assert not any(made[name].any() for name in made.dtype.names)
    assert len(record_layout.allocate_knots(2)) == 2
