"""By how much a step breaks Signorini's and Coulomb's law, against numpy on its logged contacts."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from idle_scenes import CUBE, boxes, cell
from laboratory import EVERYTHING, Bench

BELT = [0.7, -0.2, 0.0]  # [m/s]
DT = 1.0 / 240.0
COMPLIANCE = 1e-5  # [m/N] of the belt alone
PARTS = ("signorini", "cone", "dissipation")
# Both sides add the same few products of numbers below 10, in another order.
ROUND_OFF = 1e-13


def conveyor(sweeps: int = 3) -> dict[str, Any]:
    """Boxes on a soft belt that moves, solved badly on purpose."""
    bodies = boxes(CUBE, friction=0.4)
    bodies["floor"]["surface_velocity"] = BELT
    bodies["floor"]["surface"]["compliance"] = COMPLIANCE
    return cell(bodies, sweeps=sweeps)


def violations(contacts: np.ndarray) -> dict[str, np.ndarray]:
    """Return each part of each contact, from what the log and the config say of it."""
    touches_belt = (contacts["body_a"] == 0) | (contacts["body_b"] == 0)
    gamma = np.where(touches_belt, COMPLIANCE / DT**2, 0.0)
    n = contacts["impulse_n"]
    pushed = (contacts["inverse_effective_mass"] + gamma) * n
    away = contacts["normal_velocity"] + contacts["target"] + gamma * n
    slip = np.stack([contacts["slip_t1"], contacts["slip_t2"]], axis=-1)
    tangential = np.stack([contacts["impulse_t1"], contacts["impulse_t2"]], axis=-1)
    mu = contacts["friction"]
    size, speed = np.linalg.norm(tangential, axis=1), np.linalg.norm(slip, axis=1)
    power = (tangential * slip).sum(axis=1)
    return {
        "signorini": np.abs(np.where(pushed < away, pushed, away)),
        "cone": np.maximum(0.0, np.maximum(-n, size - mu * np.maximum(n, 0.0))),
        "dissipation": np.abs(power + mu * n * speed),
    }


@pytest.fixture(scope="module")
def rows() -> Any:
    return Bench(conveyor(), EVERYTHING).run(144)


def test_a_step_states_the_largest_violation_of_its_contacts(rows: Any) -> None:
    seen = dict.fromkeys(PARTS, 0.0)
    for step in rows.step[1:]:
        contacts = rows.contact[rows.contact["step"] == step["step"]]
        for part, values in violations(contacts).items():
            largest = values.max(initial=0.0)
            assert step[part] == pytest.approx(largest, abs=ROUND_OFF)
            seen[part] = max(seen[part], largest)
    # three sweeps leave much of the first and the last; impulses never leave the disc
    assert seen["signorini"] > 1e-3
    assert seen["dissipation"] > 1e-4
    assert seen["cone"] <= ROUND_OFF


def test_the_contact_named_has_the_largest_violation(rows: Any) -> None:
    named = 0
    for step in rows.step[1:]:
        contacts = rows.contact[rows.contact["step"] == step["step"]]
        for part, values in violations(contacts).items():
            worst = step[f"{part}_contact"]
            assert (worst >= 0) == (len(contacts) > 0)
            if worst >= 0:
                assert values[worst] == pytest.approx(values.max(), abs=ROUND_OFF)
                named += values[worst] > 1e-6
    assert named > 100


def test_before_the_first_step_nothing_is_broken(rows: Any) -> None:
    for part in PARTS:
        assert rows.step[0][part] == 0.0
        assert rows.step[0][f"{part}_contact"] == -1


def test_the_natural_map_is_zero_where_all_parts_are() -> None:
    """Many sweeps: what is left of the parts is what the residual leaves, times impulse or mass."""
    rows = Bench(conveyor(sweeps=2000), EVERYTHING).run(10)
    residual = rows.step["residual"].max()
    assert 0.0 < residual < 1e-5
    assert rows.step["signorini"].max() <= residual
    # Where it slides, lambda_t misses its place by residual / k_t, k_t at least 1/2 1/kg, the
    # heaviest box's: 2 |w_t| times that, slip below 5 m/s. Where it sticks, |w_t| is the residual:
    # 2 mu lambda_n times that, impulses below 10 N s.
    assert rows.step["dissipation"].max() <= residual * max(2.0 * 5.0 * 2.0, 2.0 * 0.4 * 10.0)
