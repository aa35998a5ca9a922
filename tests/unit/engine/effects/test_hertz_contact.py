"""Hertz contact: when it is required, how stiffnesses mix, what it refuses, what a contact has."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted, records
from plain_facts import facts, one_row, pair_facts

from lavendersim.engine.effects import BY_NAME
from lavendersim.engine.effects.hertz_contact import EFFECT, make, one_behind_the_other
from lavendersim.engine.record_layout import contact_dtype
from lavendersim.engine.spec import Spec
from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

SPEC = Spec(effects=("compliance", "contact_spring", "hertz_contact", "contact_midpoint"))
PRESSED = (pair_facts("floor", "ball", hertz_stiffness=1e6, hunt_crossley_dissipation=0.0),)


def test_it_is_on_where_a_pair_is_pressed_in_by_its_law_with_what_it_needs() -> None:
    asked = facts(pairs=PRESSED, compliance_law="spring")
    for name in ("hertz_contact", "contact_spring", "compliance"):
        assert BY_NAME[name].decide(asked).on
    rigid = facts(pairs=(pair_facts("floor", "ball"),), compliance_law="spring")
    for name in ("hertz_contact", "contact_spring", "compliance"):
        assert not BY_NAME[name].decide(rigid).on
    assert EFFECT.decide(asked).reason == "floor and ball: Hertz's 1e+06 N/m^1.5"


@pytest.mark.parametrize(("one", "other"), [(1e6, 1e6), (1e3, 1e9), (2e5, 7e5)])
def test_two_surfaces_are_indented_by_one_force(one: float, other: float) -> None:
    """F^(2/3) (k_1^(-2/3) + k_2^(-2/3)) deep together."""
    force = 13.0
    depth = (force / one) ** (2.0 / 3.0) + (force / other) ** (2.0 / 3.0)
    both = one_behind_the_other(one, other)
    assert both * depth**1.5 == pytest.approx(force, rel=1e-13)
    assert both == one_behind_the_other(other, one)


def test_a_rigid_surface_leaves_the_other_its_stiffness() -> None:
    assert one_behind_the_other(0.0, 1e6) == one_behind_the_other(1e6, 0.0) == 1e6
    assert one_behind_the_other(0.0, 0.0) == 0.0
    assert one_behind_the_other(1e6, 1e6) == pytest.approx(1e6 / 2.0**1.5, rel=1e-15)


def experiment(surface: str, numerics: str = "", floor: str = "{}"):
    return load_experiment_text(
        "question: q\nexpected: e\nscene:\n  bodies:\n"
        f"    floor: {{shape: {{kind: plane}}, surface: {floor}}}\n"
        "    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1], "
        f"surface: {surface}}}\n"
        f"numerics: {{timestep: 1/240{numerics}}}\nduration: 0.1\n",
        "hertz.yaml",
    ).cells()


@pytest.mark.parametrize(
    ("surface", "numerics", "floor", "why"),
    [
        ("{hertz_stiffness: 1e6}", ", compliance_law: regularised", "{}", "is regularised"),
        ("{hertz_stiffness: 1e6}", ", stabilisation_gain: 0.1", "{}", "pushes in its place"),
        ("{hertz_stiffness: 1e6}", "", "{compliance: 1e-6}", "the law of all contacts"),
        ("{hunt_crossley_dissipation: 1}", "", "{}", "needs hertz_stiffness above 0"),
        ("{hertz_stiffness: -1}", "", "{}", "a number of 0 or more"),
    ],
)
def test_what_cannot_be_is_refused(surface: str, numerics: str, floor: str, why: str) -> None:
    with pytest.raises(ConfigError, match=why):
        experiment(surface, numerics, floor)


def test_what_can_be_is_not() -> None:
    experiment("{hertz_stiffness: 1e6, hunt_crossley_dissipation: 0.1}")
    experiment("{hertz_stiffness: 0}", ", stabilisation_gain: 0.1", "{compliance: 1e-6}")


def test_a_contact_has_the_law_of_its_pair_and_begins_before_forces_act() -> None:
    contacts = np.zeros(1, contact_dtype(SPEC))
    contacts["k_n"], contacts["v_n_pre"], contacts["dv_n"] = 1.0, -0.5, -0.1
    row, kernel, params = records(contacts)[0], interpreted(make(SPEC)), one_row(dt=0.004)
    kernel(row, one_row(hertz_stiffness=0.0, hunt_crossley_dissipation=0.0), params)
    assert (row.hertz_stiffness, row.spring_compliance, row.gamma) == (0.0, 0.0, 0.0)
    kernel(row, one_row(hertz_stiffness=1e6, hunt_crossley_dissipation=0.3), params)
    assert (row.hertz_stiffness, row.dissipation, row.spring_v) == (1e6, 0.3, -0.4)
    assert row.spring_compliance > 0.0
    assert row.gamma > 0.0
