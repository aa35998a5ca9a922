"""Springs along surfaces, formula by formula: rows, stretches that are kept and how they turn."""

from __future__ import annotations

import math

import numpy as np
import pytest
from interpreted import interpreted, records
from plain_facts import one_row

from lavendersim.engine.record_layout import cache_dtype, contact_dtype, velocity_dtype
from lavendersim.engine.records import MOTION, dtype
from lavendersim.engine.spec import Spec
from lavendersim.engine.tangential_springs import (
    make_damper_work,
    make_keep_stretch,
    make_recall,
    make_yield_row,
    touching_share,
    turned,
)
from lavendersim.engine.vectors import Vec3

NEEDED = ("compliance", "contact_spring", "contact_torque", "friction", "rotation", "warm_start")
EULER = Spec(effects=tuple(sorted((*NEEDED, "tangential_compliance"))))
MEAN = EULER.including("contact_midpoint", "midpoint")
C, KAPPA, MU, DT = 1e-5, 0.8, 0.5, 0.004
K = KAPPA / C
PAIR = one_row(tangential_stiffness=KAPPA, tangential_damping_ratio=0.0, friction=MU)
PARAMS = one_row(dt=DT, cache_distance=0.1)


def contacts(spec: Spec, count: int = 1, **values: float) -> np.ndarray:
    """Return rows of contacts along z between A and B at rest, 1 mm deep, with unit tangents."""
    made = np.zeros(count, contact_dtype(spec))
    plain = {"nz": 1.0, "t1x": 1.0, "t2y": 1.0, "b": 1, "phi": -1e-3, "spring_compliance": C}
    plain |= {"mu": MU, "i_11": 0.5, "i_22": 0.25, "k_t": 4.0, "k_n": 1.0, "stretch_nz": 1.0}
    for name, value in {**plain, **values}.items():
        made[name] = value
    return made


def still(spec: Spec) -> tuple[np.ndarray, np.ndarray]:
    """Return velocities and motion of two bodies at rest."""
    return np.zeros(2, velocity_dtype(spec)), np.zeros(2, dtype(MOTION))


def yielded(spec: Spec, made: np.ndarray, pair=PAIR, params=PARAMS) -> np.ndarray:
    row, (_, motion) = records(made)[0], still(spec)
    motion["vx"][1] = 0.3
    rows = records(motion)
    interpreted(make_yield_row(spec))(row, pair, rows[0], rows[1], params)
    return made


def test_a_row_of_the_implicit_euler_rule() -> None:
    (row,) = yielded(EULER, contacts(EULER, stretch_x=2e-4, stretch_k=K))
    gamma = 1.0 / (K * DT**2)
    assert row["gamma_t"] == pytest.approx(gamma, rel=1e-15)
    assert row["surface_1"] == pytest.approx(2e-4 / DT, rel=1e-15)
    assert row["k_t"] == pytest.approx(4.0 + gamma, rel=1e-15)
    assert row["i_11"] == pytest.approx(1.0 / (2.0 + gamma), rel=1e-14)
    assert row["i_22"] == pytest.approx(1.0 / (4.0 + gamma), rel=1e-14)


def test_a_row_of_the_trapezoidal_rule_has_the_slip_of_the_start() -> None:
    (row,) = yielded(MEAN, contacts(MEAN, stretch_y=-1e-4, stretch_k=K, surface_1=0.05))
    assert row["gamma_t"] == pytest.approx(4.0 / (K * DT**2), rel=1e-15)
    # Of a belt of 0.05 m/s both ends' slips have its speed.
    assert row["surface_1"] == pytest.approx(0.3 + 2 * 0.05, rel=1e-15)
    assert row["surface_2"] == pytest.approx(-4e-4 / DT, rel=1e-15)


@pytest.mark.parametrize(("spec", "whole"), [(EULER, 1.0), (MEAN, 2.0)], ids=["euler", "mean"])
def test_a_damper_divides_both_terms_of_the_row(spec: Spec, whole: float) -> None:
    damped = one_row(tangential_stiffness=KAPPA, tangential_damping_ratio=0.25, friction=MU)
    (plain,) = yielded(spec, contacts(spec, stretch_y=2e-4, stretch_k=K))
    (row,) = yielded(spec, contacts(spec, stretch_y=2e-4, stretch_k=K), damped)
    # 2 zeta sqrt(m k_t) of m = 1/4 kg
    by = 1.0 + whole * 2.0 * 0.25 * math.sqrt(K / 4.0) / (K * DT)
    for name in ("gamma_t", "surface_2"):
        assert row[name] == pytest.approx(plain[name] / by, rel=1e-14)


@pytest.mark.parametrize(("spec", "rest"), [(EULER, 1.0), (MEAN, 0.0)], ids=["euler", "mean"])
def test_a_damper_takes_what_impulse_and_spring_leave_of_the_work(spec: Spec, rest: float) -> None:
    """p . (s_1 - s_0)/dt = U_0 - U_1 + W, of Euler's rule less 1/2 k (s_1 - s_0)^2; it sticks."""
    damped = one_row(tangential_stiffness=KAPPA, tangential_damping_ratio=0.25, friction=MU)
    made = yielded(spec, contacts(spec, stretch_x=2e-4, stretch_y=-1e-4, stretch_k=K), damped)
    made["mu"], made["lambda_n"], made["spring_v"] = 1e9, 1.0, 0.0
    made["lambda_1"], made["lambda_2"] = -0.03, 0.05
    velocities, motion = still(spec)
    v = records(velocities)
    interpreted(make_keep_stretch(spec))(records(made), 1, v, records(motion), PARAMS)
    row = made[0]
    before, after = np.array([2e-4, -1e-4]), np.array([row["stretch_x"], row["stretch_y"]])
    work = np.array([-0.03, 0.05]) @ (after - before) / DT
    lost = 0.5 * K * (after @ after - before @ before)
    lost += rest * 0.5 * K * (after - before) @ (after - before)
    found = interpreted(make_damper_work(spec))(records(made)[0])
    assert found < 0.0
    assert found == pytest.approx(work + lost, rel=1e-12)
    made["yield_damping"] = 0.0
    assert interpreted(make_damper_work(spec))(records(made)[0]) == 0.0


@pytest.mark.parametrize(
    "values", [{"spring_compliance": 0.0}, {"phi": 1e-3, "spring_v": 0.0}], ids=["rigid", "apart"]
)
def test_what_is_not_pressed_in_has_no_spring(values: dict[str, float]) -> None:
    (row,) = yielded(EULER, contacts(EULER, **values))
    assert (row["gamma_t"], row["yield_k"], row["k_t"]) == (0.0, 0.0, 4.0)
    assert row["mu"] == (0.0 if "phi" in values else MU)


def test_a_spring_that_grew_stiffer_has_the_force_that_it_had_and_else_the_stretch() -> None:
    (row,) = yielded(EULER, contacts(EULER, stretch_x=2e-4, stretch_k=0.5 * K))
    assert row["yield_1"] == pytest.approx(1e-4, rel=1e-15)
    (row,) = yielded(EULER, contacts(EULER, stretch_x=2e-4, stretch_k=2.0 * K))
    assert row["yield_1"] == 2e-4


@pytest.mark.parametrize(
    ("begin", "end", "share"), [(1.0, 2.0, 1.0), (-1.0, 3.0, 0.75), (1.0, -3.0, 0.25), (-1, -2, 0)]
)
def test_share_of_a_step_in_which_surfaces_touch(begin: float, end: float, share: float) -> None:
    assert interpreted(touching_share)(begin, end) == share


def test_the_least_turn_from_one_normal_to_another_keeps_what_is_across(
    rng: np.random.Generator,
) -> None:
    old, new = (one / np.linalg.norm(one) for one in rng.normal(size=(2, 3)))
    s = np.cross(old, rng.normal(size=3))
    found = np.array(interpreted(turned)(Vec3(*s), Vec3(*old), Vec3(*new)))
    assert found @ new == pytest.approx(0.0, abs=1e-14)
    assert np.linalg.norm(found) == pytest.approx(np.linalg.norm(s), rel=1e-14)
    axis = np.cross(old, new)
    assert found @ axis == pytest.approx(s @ axis, abs=1e-14)


def kept(spec: Spec, made: np.ndarray, spins: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
    velocities, motion = still(spec)
    velocities["wz"] = motion["wz"] = spins
    made["yield_k"], made["yield_dt"] = K, DT
    rows = [records(one) for one in (made, velocities, motion)]
    interpreted(make_keep_stretch(spec))(rows[0], 1, rows[1], rows[2], PARAMS)
    return made


def test_a_stretch_is_that_of_the_impulse() -> None:
    (row,) = kept(EULER, contacts(EULER, lambda_n=1.0, lambda_1=-0.2))
    assert row["stretch_x"] == pytest.approx(0.2 / (K * DT), rel=1e-15)
    assert row["stretch_k"] == K
    # The mean of both ends' stretches has the force.
    (row,) = kept(MEAN, contacts(MEAN, lambda_n=1.0, lambda_1=-0.08, yield_1=1e-4))
    assert row["stretch_x"] == pytest.approx(2.0 * 0.08 / (K * DT) - 1e-4, rel=1e-14)


def test_a_damper_leaves_less_of_the_impulse_to_the_stretch() -> None:
    """p = -k_t dt (s_0 + s_1)/2 - k_d (s_1 - s_0), k_d = h k_t dt/2; of Euler's rule s_1, h."""
    for spec, whole in ((EULER, 1.0), (MEAN, 2.0)):
        pushed = contacts(spec, lambda_n=9.0, lambda_1=-0.06, yield_1=1e-4, yield_damping=0.6)
        (row,) = kept(spec, pushed)
        s_0, s_1 = 1e-4, row["stretch_x"]
        sprung = s_1 if spec is EULER else 0.5 * (s_0 + s_1)
        held = K * DT * (sprung + 0.6 / whole * (s_1 - s_0))
        assert held == pytest.approx(0.06, rel=1e-13)


def test_a_stretch_ends_no_longer_than_friction_holds() -> None:
    """At 1 mm depth F_n is 100 N, whatever the mean force of the step was."""
    (row,) = kept(MEAN, contacts(MEAN, lambda_n=9.0, lambda_2=-4.0))
    assert row["stretch_y"] == pytest.approx(MU * 1e-3 / C / K, rel=1e-14)


@pytest.mark.parametrize("spec", [EULER, MEAN], ids=["euler", "mean"])
def test_a_stretch_turns_about_the_normal_with_the_mean_of_both_spins(spec: Spec) -> None:
    pushed = contacts(spec, lambda_n=1.0, lambda_1=-0.06, lambda_2=-0.08)
    (row,) = kept(spec, pushed, (30.0, 10.0))
    turn = math.atan2(0.08, 0.06) + 2.0 * math.atan(0.5 * 20.0 * DT)
    found = math.atan2(row["stretch_y"], row["stretch_x"])
    assert found == pytest.approx(turn, rel=1e-13)


def test_without_a_spring_there_is_no_stretch() -> None:
    made = contacts(EULER, stretch_x=1e-4, stretch_k=K)
    velocities, motion = still(EULER)
    rows = [records(one) for one in (made, velocities, motion)]
    interpreted(make_keep_stretch(EULER))(rows[0], 1, rows[1], rows[2], PARAMS)
    assert (made["stretch_x"][0], made["stretch_k"][0]) == (0.0, 0.0)


def test_a_stretch_is_recalled_by_feature_and_else_by_the_nearest_place() -> None:
    made = contacts(EULER, 4, key=7)
    made["feature"], made["x"] = (1, 2, 3, 4), (0.0, 5.0, 0.3, 0.32)
    cache = np.zeros(4, cache_dtype(EULER))
    cache["key"], cache["stretch_k"] = (6, 7, 7, 7), K
    cache["feature"], cache["rx"] = (1, 2, 9, 8), (0.0, 0.0, 0.31, 2.0)
    cache["stretch_x"] = (1.0, 2.0, 3.0, 4.0)
    bodies = records(np.zeros(2, dtype([(axis, "f8") for axis in "xyz"])))
    recall = interpreted(make_recall(EULER))
    recall(records(made), 4, bodies, records(cache), one_row(cached=4), PARAMS)
    # Of another pair; by feature, however far it rolled; the nearest, once; what is too far.
    assert made["stretch_x"].tolist() == [0.0, 2.0, 3.0, 0.0]
    assert made["stretch_k"].tolist() == [0.0, K, K, 0.0]
