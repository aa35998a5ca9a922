"""A contact keeps of the start of the step what its rows at the middle ask for, and no more."""

from __future__ import annotations

import pytest
from plain_facts import facts, pair_facts

from lavendersim.engine.effects.contact_midpoint import EFFECT, contact_fields
from lavendersim.engine.spec import Spec

FRICTION = {"kept_1", "kept_2", "surface_1", "surface_2", "begin_x", "begin_y", "begin_z", "slides"}
SWEPT = {"at_tx", "at_ty", "at_tz"}
TORQUES = {"kept_psi_n", "kept_psi_1", "kept_psi_2"}


@pytest.mark.parametrize(
    ("effects", "expected"),
    [
        ((), set()),
        (("fast_bodies",), SWEPT),
        (("friction",), FRICTION),
        (("fast_bodies", "friction"), SWEPT | FRICTION),
        (("friction", "torsional_friction"), FRICTION | TORQUES),
        (("friction", "rolling_friction"), FRICTION | TORQUES),
    ],
)
def test_columns_are_those_of_the_rows_that_there_are(effects, expected) -> None:
    names = [name for name, _ in contact_fields(Spec(effects=effects))]
    assert len(names) == len(set(names))
    assert set(names) == expected


def test_it_is_on_where_the_integrator_asks_for_it_and_something_can_touch() -> None:
    pairs = (pair_facts("floor", "box"),)
    assert EFFECT.decide(facts(pairs=pairs, integrator="midpoint_contact")).on
    assert not EFFECT.decide(facts(integrator="midpoint_contact")).on
    assert not EFFECT.decide(facts(pairs=pairs, integrator="midpoint")).on
