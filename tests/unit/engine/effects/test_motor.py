"""When a scene requires motors, and what they log: work by the mean speed, couples."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from interpreted import interpreted
from test_joint_stop import TEXT, planned

from lavendersim.engine.effects.motor import EFFECT, make_contact_row
from lavendersim.engine.row_terms import row_terms
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import build
from lavendersim.scene.facts import facts_of

DRIVEN = TEXT.replace("axis: [0, 1, 0]", "axis: [0, 1, 0], motor: {speed: 3, max_torque: 5}")
SWAPPED = DRIVEN.replace("between: [hook, bob]", "between: [bob, hook]")


def test_a_motor_requires_it_and_parts_of_a_step_where_it_reaches_its_speed() -> None:
    plan = planned(DRIVEN)
    assert plan.decisions["motor"].reason == "hook and bob: a motor drives the joint"
    assert row_terms(plan.spec).bounded
    assert "joint_stop" not in plan.spec.effects
    reason = "hook and bob: a motor reaches its speed within a step"
    assert plan.decisions["impact_order"].reason == reason
    assert "impact_order" not in planned(TEXT).spec.effects
    assert planned(TEXT).decisions["motor"].reason == "no motor drives a joint"
    config = load_experiment_text(DRIVEN, "x.yaml").cells()[0].config
    assert [pair.row_pairs for pair in facts_of(config).pairs] == [6]


@pytest.mark.parametrize(("text", "sign"), [(DRIVEN, 1.0), (SWAPPED, -1.0)])
def test_its_row_has_speed_and_most_as_the_later_body_has_them(text: str, sign: float) -> None:
    """Both are of the second body of `between` against the first; B is the later row."""
    config = load_experiment_text(text, "x.yaml").cells()[0].config
    pairs = build(config, planned(text).spec).pairs
    assert pairs["motor_speed"].tolist() == pytest.approx([0.0] * 5 + [sign * 3.0], abs=1e-15)
    assert pairs["motor_most"].tolist() == pytest.approx([0.0] * 5 + [5.0], abs=1e-15)


def body(spin: float) -> Any:
    still = dict.fromkeys(("vx", "vy", "vz", "wx", "wy"), 0.0)
    return SimpleNamespace(**still, wz=spin)


def row(**fields: Any) -> Any:
    zeros = [f"lever_{b}{axis}" for b in "ab" for axis in "xyz"] + ["nx", "ny", "nz"]
    known = dict.fromkeys(zeros, 0.0) | {"lever_az": 0.5, "lever_bz": 0.5}
    known |= {"motor": 1, "couple": 1, "lasts": 1, "driven": 0.4, "lambda_n": 2.0}
    return SimpleNamespace(**known | fields)


@pytest.mark.parametrize(("lasts", "speed"), [(1, 0.5 * (0.4 + 1.5)), (0, 1.5)])
def test_its_work_is_by_the_speed_that_bodies_move_by(lasts: int, speed: float) -> None:
    out: Any = SimpleNamespace()
    log = interpreted(make_contact_row(planned(DRIVEN).spec))
    log(out, row(lasts=lasts), body(-1.0), body(2.0))
    assert out.motor_work == pytest.approx(2.0 * speed, rel=1e-15)
    np.testing.assert_array_equal([out.twist_x, out.twist_y, out.twist_z], [0, 0, 1.0])


def test_other_rows_do_no_work_and_twist_nothing() -> None:
    out: Any = SimpleNamespace()
    interpreted(make_contact_row(planned(DRIVEN).spec))(out, row(motor=0), body(0.0), body(2.0))
    assert {*vars(out).values()} == {0.0}
    assert EFFECT.balance.work in [column.name for column in EFFECT.step_columns]
