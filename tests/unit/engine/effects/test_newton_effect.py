"""Newton's method is there where some step may have two rows that trade impulses."""

from __future__ import annotations

import pytest
from plain_facts import body_facts, facts, pair_facts

from lavendersim.engine.effects.newton import EFFECT, contact_fields
from lavendersim.engine.spec import Spec

BALL_ON_PLANE = (
    body_facts("floor", "plane", movable=False),
    body_facts("ball", "sphere"),
)


def on(*bodies, surface=None, pair_count=1, **numerics) -> bool:
    pair = pair_facts(bodies[0].name, bodies[1].name, **(surface or {}))
    return EFFECT.decide(facts(*bodies, pairs=(pair,), pair_count=pair_count, **numerics)).on


def test_one_frictionless_point_is_solved_by_its_sweep() -> None:
    box = body_facts("box", "box")
    assert not on(*BALL_ON_PLANE)
    assert on(*BALL_ON_PLANE, surface={"friction": 0.5})
    assert on(*BALL_ON_PLANE, surface={"rolling_friction": 1e-3})
    assert on(*BALL_ON_PLANE, pair_count=2)
    assert on(BALL_ON_PLANE[0], box)
    assert not EFFECT.decide(facts(box)).on


@pytest.mark.parametrize(
    "numerics",
    [{"solver": "jacobi"}, {"friction_cone": "pyramid"}, {"friction_cone": "convex"}],
)
def test_other_solvers_and_cones_are_left_to_sweeps(numerics) -> None:
    box = body_facts("box", "box")
    assert on(BALL_ON_PLANE[0], box, surface={"friction": 0.5})
    assert not on(BALL_ON_PLANE[0], box, surface={"friction": 0.5}, **numerics)


@pytest.mark.parametrize(
    ("effects", "torques"),
    [
        (("friction",), set()),
        (("friction", "torsional_friction"), {"spin_n", "limit_torsion"}),
        (("friction", "rolling_friction"), {"spin_1", "spin_2", "limit_roll"}),
    ],
)
def test_a_contact_has_columns_of_the_torques_that_there_are(effects, torques) -> None:
    names = [name for name, _ in contact_fields(Spec(effects=effects))]
    assert len(set(names)) == len(names)
    known = {"spin_n", "spin_1", "spin_2", "limit_torsion", "limit_roll"}
    assert known & set(names) == torques
    assert {"start_n", "best_2", "velocity_1", "step_n", "shift", "stiff_t"} <= set(names)
