"""Pushes of joints by Newton's method: it has the rows for a while, and gives them back."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from interpreted import interpreted

from lavendersim.engine import joint_projection
from lavendersim.engine.effects.projection import projects_joints
from lavendersim.engine.joint_projection import make_project_joints
from lavendersim.engine.spec import Spec

JOINED = ("compound", "frictionless_contact", "joint", "newton", "projection", "warm_start")
FULL = Spec((*JOINED, "compliance", "contact_torque", "friction", "motor", "rotation"), ())
ROW = {
    **{"lambda_n": 5.0, "push": 0.25, "target": 0.5, "correction": -0.125, "motor": 0},
    **{"mu": 0.3, "lambda_1": 1.0, "lambda_2": 2.0, "gamma": 0.7, "most": 9.0},
}


def test_it_is_where_joints_are_solved_by_newton_and_no_contact_has_torques() -> None:
    assert projects_joints(FULL)
    assert not projects_joints(Spec(tuple(one for one in JOINED if one != "newton"), ()))
    assert not projects_joints(Spec((*FULL.effects, "rolling_friction"), ()))
    assert not projects_joints(Spec(("friction", "newton", "projection"), ()))


@pytest.mark.parametrize(("cost", "solved"), [(1e3, True), (1e9, False)])
def test_rows_are_pushes_without_friction_and_then_what_they_were(
    monkeypatch: pytest.MonkeyPatch, cost: float, solved: bool
) -> None:
    rows = [SimpleNamespace(**ROW), SimpleNamespace(**ROW | {"motor": 1})]
    seen: list[dict[str, Any]] = []

    def newton(system: Any, workspace: Any, size: int, most: float, tolerance: float, rest: bool):
        for contact in system.contacts:
            seen.append({name: getattr(contact, name) for name in ROW})
            contact.lambda_n = 0.5
        return 1, True

    from lavendersim.engine.solvers.newton import method

    monkeypatch.setattr(method, "make_newton", lambda spec: newton)
    monkeypatch.setattr(method, "step_cost", lambda system, workspace: (1, cost))
    kernel = interpreted(make_project_joints(FULL))
    kernel(SimpleNamespace(contacts=rows, count=2), None, 1e-12)
    assert bool(seen) == solved
    if solved:
        alone = {"mu": 0.0, "lambda_1": 0.0, "lambda_2": 0.0, "gamma": 0.0}
        pushed = {"lambda_n": 0.25, "target": 0.125}
        assert [one | alone | pushed for one in seen] == seen
        assert [one["most"] for one in seen] == [9.0, 0.0]  # a motor moves nothing apart
    for contact in rows:
        kept = ROW | {"push": 0.5 if solved else 0.25, "motor": contact.motor}
        assert {name: getattr(contact, name) for name in ROW} == kept
    assert joint_projection.STEPS >= method.FEWEST_STEPS
