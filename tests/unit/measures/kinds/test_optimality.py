"""The laws of contact on rows that keep them, and on the same rows with one of them broken."""

from __future__ import annotations

import math
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.lib.recfunctions as recfunctions
import pytest
from synthetic import MASS, contacts, log_of, scene_of

from lavendersim.errors import NotReportedError
from lavendersim.measures import evaluate
from lavendersim.measures.specs.optimality import Optimality
from tests import engines

SPEC = Optimality(kind="optimality")
PUSHING, COMPLEMENTARY, CONE, SLIDING = range(4)


def log_with(
    row: dict[str, float],
    friction: bool = True,
    numerics: Any = MappingProxyType({}),
    friction_of_surfaces: float = 0.5,
    **surface: Any,
) -> Any:
    """One contact of ball and floor in step 1, that sticks and carries 1 N s but for `row`."""
    floor = {"shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}}
    surface = {"friction": friction_of_surfaces} | surface
    ball = {"shape": {"kind": "sphere", "radius": 0.1}, "mass": MASS, "surface": surface}
    scene = scene_of({"floor": floor | {"surface": surface}, "ball": ball})
    scene["numerics"] = scene["numerics"] | numerics
    log = log_of(scene, np.zeros((3, 2, 3)))
    added = {"target": 0.0}
    if friction:
        added |= {"impulse_t1": 0.3, "impulse_t2": 0.0, "slip_t1": 0.0, "slip_t2": 0.0}
        added |= {"friction": 0.5}
    log.contact = recfunctions.append_fields(
        contacts([(1, 1.0, 0.0)]), list(added), [[one] for one in added.values()], usemask=False
    )
    log.contact["normal_velocity"] = 0.0
    for name, value in row.items():
        log.contact[name] = value
    return log


def violations(row: dict[str, float], residual: float = 0.0, **options: Any) -> list[float]:
    log = log_with(row, **options)
    log.step["residual"] = [9.0, residual, 9.0]
    return list(evaluate(SPEC, log))


@pytest.mark.parametrize(
    "row",
    [
        {},
        {"impulse_n": 0.0, "impulse_t1": 0.0, "normal_velocity": 0.7, "slip_t2": 3.0},
        {"impulse_t1": -0.3, "impulse_t2": 0.4, "slip_t1": 0.6, "slip_t2": -0.8},  # slides
        {"impulse_t1": 0.5},  # on the edge of the cone
        {"target": 2.0, "normal_velocity": -2.0},  # closes a gap in this step, no more
        {"target": 2.0, "normal_velocity": -1.0, "impulse_n": 0.0, "impulse_t1": 0.0},
        {"target": -1.5, "normal_velocity": 1.5},  # bounces,
    ],
)
def test_rows_that_keep_every_law_violate_none(row: dict[str, float]) -> None:
    assert violations(row) == pytest.approx([0.0] * 4, abs=1e-15)


# k_n = 1/MASS = 0.5, and the sum of inverse masses as well
@pytest.mark.parametrize(
    ("law", "row", "size"),
    [
        (PUSHING, {"impulse_n": -0.2, "impulse_t1": 0.0}, 0.1),
        (COMPLEMENTARY, {"normal_velocity": 0.1}, 0.1),  # pushes and leaves
        (COMPLEMENTARY, {"normal_velocity": 3.0}, 0.5),
        (COMPLEMENTARY, {"normal_velocity": -0.1}, 0.1),  # goes on into the floor
        (COMPLEMENTARY, {"target": 2.0, "normal_velocity": -2.5}, 0.5),
        (CONE, {"impulse_t1": 0.4, "impulse_t2": 0.4}, 0.5 * (math.hypot(0.4, 0.4) - 0.5)),
        (SLIDING, {"slip_t1": -0.05}, 0.05),  # slides although it could stick
        (SLIDING, {"impulse_t1": 0.5, "slip_t1": 1.0}, 0.5),  # friction helps it along
        (SLIDING, {"impulse_t1": 0.5, "slip_t2": 100.0}, 0.25 * math.sqrt(2.0)),  # across it
        (SLIDING, {"impulse_t1": 0.0, "slip_t1": 100.0}, 0.25),  # slides without friction
    ],
)
def test_a_broken_law_shows_by_its_size(law: int, row: dict[str, float], size: float) -> None:
    # the edge between sliding across and along is met at 100 m/s to 0.25/100 of the size
    assert violations(row)[law] == pytest.approx(size, rel=2e-3)


def test_the_residual_of_the_own_step_is_allowed() -> None:
    row = {"normal_velocity": -0.1, "slip_t1": -0.05}
    assert violations(row, residual=0.02) == pytest.approx([0.0, 0.08, 0.0, 0.03], abs=1e-15)
    assert violations(row, residual=0.2) == [0.0] * 4
    cone = {"impulse_t1": 0.6}
    assert violations(cone, residual=1.0)[CONE] == pytest.approx(0.05)  # no residual excuses it


def test_without_friction_two_laws_are_left_and_without_contacts_none() -> None:
    assert len(violations({}, friction=False)) == 2
    log = log_with({})
    log.contact = log.contact[:0]
    assert np.isnan(evaluate(SPEC, log)).all()


def test_a_log_without_targets_has_no_answer() -> None:
    log = log_with({})
    log.contact = recfunctions.drop_fields(log.contact, ["target"])
    assert np.isnan(evaluate(SPEC, log)).all()


def test_nan_in_a_row_is_no_pass() -> None:
    assert math.isnan(violations({"normal_velocity": float("nan")})[COMPLEMENTARY])


def test_compliance_gives_way_by_gamma_lambda() -> None:
    # two surfaces of 1e-6 m/N in series over (10 ms)^2: gamma = 0.02 1/kg
    row = {"normal_velocity": -0.02}
    assert violations(row, compliance=1e-6)[COMPLEMENTARY] == pytest.approx(0.0, abs=1e-15)
    assert violations(row)[COMPLEMENTARY] == pytest.approx(0.02)


def test_compliance_and_friction_of_a_pair_take_the_place_of_what_its_surfaces_mix_to() -> None:
    partner = {"surface": "alike", "friction": 0.5, "compliance": 2e-6}
    paired = {"friction_of_surfaces": 0.0, "name": "alike", "partners": [partner]}
    row = {"normal_velocity": -0.02}
    assert violations(row, **paired) == pytest.approx([0.0] * 4, abs=1e-15)
    assert violations(row, friction_of_surfaces=0.0)[COMPLEMENTARY] == pytest.approx(0.02)
    assert violations({}, friction_of_surfaces=0.0)[CONE] == pytest.approx(0.15)  # 0.3 N s / 2 kg


def test_friction_is_that_of_the_config_whatever_the_log_says_of_it() -> None:
    row = {"impulse_t1": 0.4, "friction": 0.5}
    assert violations(row)[CONE] == 0.0
    assert violations(row, friction_of_surfaces=0.3)[CONE] == pytest.approx(0.5 * 0.1)


def test_the_pyramid_bounds_each_tangent_by_itself() -> None:
    row = {"impulse_t1": 0.4, "impulse_t2": 0.4}
    assert violations(row)[CONE] > 0.02
    assert violations(row, numerics={"friction_cone": "pyramid"})[CONE] == 0.0


@pytest.mark.parametrize("row", [{}, {"slip_t1": -0.05}, {"impulse_t1": 0.5, "slip_t2": 100.0}])
def test_a_surface_that_moves_by_itself_is_judged_by_its_slip(row: dict[str, float]) -> None:
    log = log_with(row)
    log.resolved["scene"]["bodies"]["floor"]["surface_velocity"] = [1.0, 0.0, 0.0]
    log.step["residual"] = [9.0, 0.0, 9.0]
    assert list(evaluate(SPEC, log)) == violations(row)


@pytest.mark.parametrize("worst", range(4))
def test_the_worst_contact_of_all_parts_counts(worst: int) -> None:
    """Four parts of a log, of which one has a row that breaks each law; another is empty."""
    broken = {"impulse_n": -1.0, "impulse_t1": 3.0, "normal_velocity": 0.1, "slip_t1": 1.0}
    log, other = log_with({}), log_with(broken)
    parts = [log.contact, log.contact[:0], log.contact, log.contact]
    parts[worst] = other.contact
    log.contacts_in_parts = lambda: iter(parts)
    assert list(evaluate(SPEC, log)) == list(evaluate(SPEC, other))
    assert min(evaluate(SPEC, other)) > 0.1  # [m/s]


def test_what_is_no_number_in_one_part_is_none_of_the_whole() -> None:
    log, other = log_with({}), log_with({"impulse_n": math.nan})
    for parts in ([log.contact, other.contact], [other.contact, log.contact]):
        log.contacts_in_parts = lambda parts=parts: iter(parts)
        found = evaluate(SPEC, log)
        assert np.isnan(found).tolist() == np.isnan(evaluate(SPEC, other)).tolist()
        assert np.isnan(found[[PUSHING, COMPLEMENTARY, CONE]]).all()


@engines.needs("mujoco")
def test_of_an_engine_that_tells_no_targets_the_laws_are_not_judged(tmp_path: Path) -> None:
    text = engines.BOX.replace("duration: 0.5", "duration: 0.05")
    log = engines.log_of(engines.run_by(text, "mujoco", tmp_path))
    assert len(log.contact) > 0
    with pytest.raises(NotReportedError):
        evaluate(SPEC, log)


def test_rows_of_joints_have_no_cone() -> None:
    log = log_with({"impulse_n": -3.0})
    log.step["residual"] = [9.0, 0.0, 9.0]
    assert evaluate(SPEC, log)[PUSHING] > 0.0
    ones = np.ones(len(log.contact), np.int64)
    log.contact = recfunctions.append_fields(log.contact, "joint", ones, usemask=False)
    assert math.isnan(evaluate(SPEC, log)[0])  # there is no other row
    log.contact["joint"] = 0
    assert evaluate(SPEC, log)[PUSHING] > 0.0


def of_ellipse(impulse: np.ndarray, slip: np.ndarray, section: np.ndarray) -> list[float]:
    """The violations of a contact with 1 N s along its normal and this section of the cone."""
    row = dict(zip(("impulse_t1", "impulse_t2"), impulse.tolist(), strict=True))
    row |= dict(zip(("slip_t1", "slip_t2"), slip.tolist(), strict=True))
    log = log_with(row)
    added = {"friction_11": section[0, 0], "friction_12": section[0, 1]}
    added |= {"friction_22": section[1, 1]}
    log.contact = recfunctions.append_fields(
        log.contact, list(added), [[one] for one in added.values()], usemask=False
    )
    return list(evaluate(SPEC, log))


def test_of_an_ellipse_maximum_dissipation_is_the_law() -> None:
    """lambda_t = -F^2 v / |F v|; as long a force against the slip leaves the ellipse, or less."""
    section, slip = np.array([[0.6, 0.1], [0.1, 0.3]]), np.array([0.4, -0.7])
    stretched = section @ slip
    impulse = -section @ stretched / np.linalg.norm(stretched)
    assert of_ellipse(impulse, slip, section) == pytest.approx([0.0] * 4, abs=1e-14)
    assert of_ellipse(0.9 * impulse, 0.0 * slip, section) == pytest.approx([0.0] * 4, abs=1e-14)
    assert of_ellipse(1.1 * impulse, slip, section)[CONE] > 0.01
    inside = -0.25 * slip / np.linalg.norm(slip)
    assert of_ellipse(inside, slip, section)[SLIDING] > 0.01
