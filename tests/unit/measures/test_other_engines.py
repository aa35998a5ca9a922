"""Checks of every step that the log of an engine cannot answer."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.measures.other_engines import unanswered
from tests.engines import BOX


@pytest.mark.parametrize(
    ("engine", "checks"),
    [
        ("lavender", set()),
        ("mujoco", {"residual"}),
        ("mujoco-rk4", {"residual", "impulses", "momentum"}),
    ],
)
def test_a_check_is_left_where_an_engine_reports_too_little(engine: str, checks: set[str]) -> None:
    config = load_experiment_text(f"{BOX}engine: {engine}\n", "box.yaml").cells()[0].config
    log: Any = SimpleNamespace(config=config)
    assert set(unanswered(log)) == checks


def test_penetration_needs_a_closed_form_of_every_pair() -> None:
    text = BOX.replace(
        "{kind: box, size: [0.4, 0.4, 0.2]}",
        "{kind: hull, points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}",
    )
    config = load_experiment_text(f"{text}engine: mujoco\n", "hull.yaml").cells()[0].config
    log: Any = SimpleNamespace(config=config)
    assert unanswered(log)["penetration"].startswith("no closed form for the depth of a hull")
