"""The log has of each contact what the solve left, and of a step their sums and extremes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import Drawn, drawn, views
from interpreted import interpreted, records
from plain_facts import facts, one_row, pair_facts

from lavendersim.engine.effects.contact_log import EFFECT, force_of, make, penetration_of
from lavendersim.engine.memory import Log, allocate_counters
from lavendersim.engine.record_layout import contact_row_dtype, step_row_dtype
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("contact_log", "contact_torque", "rotation", "step_log"))
AHEAD = SPEC.including("speculative")
DT = 0.01
PAIRS = [(0, 1), (1, 2), (2, 0)]


def logged(spec: Spec, scene: Drawn, worst: int = -1) -> tuple[np.ndarray, Any, Any]:
    """Return the rows of contacts, the row of the step and the counters; two rows were there."""
    rows = np.zeros(2 + len(PAIRS), contact_row_dtype(spec))
    steps, none = np.zeros(1, step_row_dtype(spec)), np.zeros(0)
    counters = allocate_counters()
    counters["step"], counters["contact_rows"], counters["residual_contact"] = 4, 2, worst
    counters["residual"] = 0.5
    log = Log(records(steps), none, records(rows), none, none, none)
    _, velocities, contacts = views(scene)
    kernel = interpreted(make(spec, ()))
    params = one_row(dt=DT, timestep=DT)
    kernel(contacts, len(PAIRS), velocities, params, records(counters)[0], log)
    return rows[2:], records(steps)[0], records(counters)[0]


def scene_of(rng: np.random.Generator, spec: Spec = SPEC) -> Drawn:
    scene = drawn(spec, rng, PAIRS)
    scene.contacts["phi"], scene.contacts["v_n_pre"] = [-0.01, 0.02, -0.03], [0.1, 0.2, 0.3]
    scene.contacts["feature"] = [7, 8, 9]
    return scene


def test_a_row_has_the_contact_as_the_solve_left_it(rng) -> None:
    scene = scene_of(rng)
    rows, step, counters = logged(SPEC, scene, worst=2)
    contacts = scene.contacts
    assert rows["step"].tolist() == [5] * 3  # four are done
    for column, field in (
        ("body_a", "a"), ("body_b", "b"), ("feature", "feature"), ("separation", "phi"),
        ("approach_velocity", "v_n_pre"), ("impulse_n", "lambda_n"), ("target", "target"),
        ("inverse_effective_mass", "k_n"), *((name, name) for name in ("x", "y", "z")),
        *((name, name) for name in ("nx", "ny", "nz")),
    ):  # fmt: skip
        np.testing.assert_array_equal(rows[column], contacts[field], err_msg=column)
    v_n = (scene.jacobian @ scene.motion)[::3]
    np.testing.assert_allclose(rows["normal_velocity"], v_n, atol=1e-14)
    natural = np.abs(np.minimum(v_n + contacts["target"], contacts["k_n"] * contacts["lambda_n"]))
    np.testing.assert_allclose(rows["residual"], natural, atol=1e-13)
    np.testing.assert_array_equal(rows["penetration"], [0.01, 0.0, 0.03])
    forces = contacts["lambda_n"] / DT
    np.testing.assert_allclose(rows["force_n"], forces, rtol=1e-15)
    assert step.total_normal_force == pytest.approx(forces.sum(), rel=1e-14)
    assert (step.max_penetration, step.contact_count, step.residual) == (0.03, 3, 0.5)
    assert counters.residual_row == 2
    assert counters.signorini == pytest.approx(natural.max(), abs=1e-13)
    assert counters.signorini_contact == natural.argmax()


def test_speculative_rows_that_neither_touch_nor_push_are_left_out(rng) -> None:
    scene = scene_of(rng, AHEAD)
    scene.contacts["phi"] = [0.01, 0.02, 0.0]
    scene.contacts["lambda_n"] = [0.0, 1.0, 0.0]
    rows, step, counters = logged(AHEAD, scene, worst=2)
    assert step.contact_count == 2
    assert rows["feature"].tolist() == [8, 9, 0]
    assert counters.residual_row == 1  # by its place among those that are logged
    scene.contacts["lambda_n"][1] = 0.0
    assert logged(AHEAD, scene)[1].contact_count == 1


def test_a_depth_that_is_no_number_is_the_deepest(rng) -> None:
    scene = scene_of(rng)
    scene.contacts["phi"][1] = np.nan
    assert np.isnan(logged(SPEC, scene)[1].max_penetration)
    found = penetration_of({"separation": np.array([-0.01, 0.0, 0.02, np.nan])}, DT)
    np.testing.assert_array_equal(found, [0.01, 0.0, 0.0, np.nan])
    assert force_of({"impulse_n": np.array([0.5])}, DT).tolist() == [50.0]


def test_derived_columns_give_back_what_the_kernel_wrote(rng) -> None:
    rows, _, _ = logged(SPEC, scene_of(rng))
    derived = {column.name: column.derived for column in EFFECT.contact_columns if column.derived}
    assert set(derived) == {"penetration", "force_n"}
    for name, rule in derived.items():
        np.testing.assert_array_equal(rule.value(rows, DT), rows[name])


def test_it_is_on_where_the_run_is_logged_and_something_can_touch() -> None:
    pairs = (pair_facts("floor", "box"),)
    assert EFFECT.decide(facts(pairs=pairs)).on
    assert not EFFECT.decide(facts(pairs=pairs, record=False)).on
    assert not EFFECT.decide(facts()).on
