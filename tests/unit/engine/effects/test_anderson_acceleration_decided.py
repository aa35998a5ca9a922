"""Anderson's acceleration is decided on by the plan, which says why."""

from __future__ import annotations

from typing import Any

import pytest
from laboratory import plane, planned, resolved, sphere

from lavendersim.engine.effects.anderson_acceleration import PLAIN_SWEEPS
from lavendersim.engine.effects.decision import Decision
from lavendersim.engine.effects.packed_sweeps import FEWEST_BODIES

GRAVITY = (0.0, 0.0, -9.81)


def decided(count: int = FEWEST_BODIES, surface: Any = None, **numerics: Any) -> Decision:
    surface = {"friction": 0.5} if surface is None else surface
    balls = {f"ball_{k}": sphere(0.1, (0.3 * k, 0.0, 0.1), **surface) for k in range(count)}
    numerics = {"solver": "adaptive", "sweeps": PLAIN_SWEEPS + 1, **numerics}
    cell = resolved({"floor": plane(**surface), **balls}, GRAVITY, **numerics)
    return planned(cell).decisions["anderson_acceleration"]


def test_long_solves_of_many_bodies_have_it() -> None:
    assert decided() == (True, "a solve of many contacts may take 65 sweeps")


@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        ({"sweeps": PLAIN_SWEEPS}, "a solve has 64 sweeps, no more than 64"),
        ({"count": FEWEST_BODIES - 1}, "199 movable bodies, fewer than 200"),
        ({"solver": "block_gauss_seidel"}, "the solver is block_gauss_seidel"),
        ({"surface": {}}, "no pair of surfaces has friction"),
        (
            {"surface": {"friction": 0.5, "rolling_friction": 0.01}},
            "contacts that resist turning are swept plainly",
        ),
    ],
    ids=lambda case: str(case)[:40],
)
def test_others_do_not_and_the_plan_says_why(scene: dict[str, Any], reason: str) -> None:
    assert decided(**scene) == (False, reason)
