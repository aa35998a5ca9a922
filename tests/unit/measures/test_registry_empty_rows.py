"""A row without numbers answers nothing: it is NaN, and no judgement passes it."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lavendersim.measures import judge
from lavendersim.measures.registration import FUNCTIONS
from lavendersim.measures.registry import evaluate
from lavendersim.measures.specs.convergence import ResidualBySweep
from lavendersim.measures.specs.expectation import ExpectSpec

ROW = ResidualBySweep(kind="residual_by_sweep", after=0.0)


@pytest.fixture(autouse=True)
def without_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(FUNCTIONS, ResidualBySweep, lambda spec, trace: np.empty(0))


def cells() -> list[Any]:
    run = SimpleNamespace(step={"time": np.array([0.0, 1.0])})
    shared = {"trace": lambda: run, "status": "complete", "path": Path("a.mcap")}
    return [
        SimpleNamespace(index=k, label=f"m={m}", coordinates={"m": m}, **shared)
        for k, m in enumerate((1, 2))
    ]


def test_it_is_one_nan() -> None:
    value = evaluate(ROW, SimpleNamespace())
    np.testing.assert_array_equal(value, [np.nan])


@pytest.mark.parametrize(
    "claim",
    [
        {"at_most": 1.0},
        {"at_least": 0.0},
        {"between": (0.0, 1.0)},
        {"exactly": 0.0},
        {"row": "increasing"},
        {"increasing": {"along": "m"}},
    ],
)
def test_no_judgement_passes_it(claim: dict[str, Any]) -> None:
    spec = ExpectSpec.model_validate({"name": "it is there", "measure": "row", **claim})
    verdicts = judge({"row": ROW}, [spec], cells())
    assert verdicts
    assert [verdict.passed for verdict in verdicts] == [False] * len(verdicts)
