"""Impacts at several speeds and timesteps, and the experiment whose figure shows them."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np
from synthetic import RESIDUAL, SyntheticCell, ball_and_floor, trace_of

from lavendersim.experiment.models.axis import Axis
from lavendersim.figures.specs.catalogue import FigureSpec
from lavendersim.measures.specs.convergence import ResidualBySweep
from lavendersim.measures.specs.impact import ImpactImpulse

MEASURES = {
    "impulse": ImpactImpulse(kind="impact_impulse", body="ball"),
    "residual": ResidualBySweep(kind="residual_by_sweep", after=0.0),
}
LABELS = {"title": "one idea", "x_label": "there [m]", "y_label": "here [N s]"}
AGAINST_AXIS = LABELS | {
    "kind": "measure_against_axis",
    "measure": "impulse",
    "axis": "speed",
    "series": "timestep",
    "series_label": "timestep {} s",
    "ideal": {
        "closed_form": {"form": "newton_impulse", "bodies": ("floor", "ball")},
        "label": "Newton",
    },
    "levels": ({"value": 4.0, "label": "four"},),
    "onsets": ({"level": 4.0, "label": "onset"},),
}
ROW = LABELS | {"kind": "row_against_index", "measure": "residual", "y_scale": "log"}
TIME = LABELS | {
    "kind": "time_series",
    "column": "normal_force",
    "body": "ball",
    "start": "first_contact",
    "window": (-0.015, 0.015),
    "factor": 0.001,
    "ideal": {"closed_form": {"form": "weight", "bodies": ("ball",)}, "label": "m g"},
}


def cells() -> list[SyntheticCell]:
    """Impacts at four speeds and two timesteps; the coarser gives a tenth more impulse."""
    made = []
    for timestep in (Fraction(1, 100), Fraction(1, 200)):
        for speed in (-1.0, -2.0, 1.0, -4.0):
            config = ball_and_floor(position=[0, 0, 0.1], velocity=[0.0, 0.0, speed])
            impulse = max(0.0, -3.0 * speed) * (1.1 if timestep == Fraction(1, 100) else 1.0)
            log = trace_of([0.0] * 6, [(3, impulse, 1e-4)], resolved=config)
            log.residual = np.array([(1, 0, 1.0), (1, 1, 0.1), (1, 2, 0.0)], RESIDUAL)
            made.append(SyntheticCell({"timestep": timestep, "speed": speed}, log))
    return made


def experiment(*panels: dict[str, Any]) -> Any:
    sweep = {"speed": Axis(path="scene.bodies.ball.velocity.2", values=(1.0,))}
    return SimpleNamespace(
        name="some_experiment",
        measures=MEASURES,
        config=SimpleNamespace(
            question="What is asked?",
            figure=FigureSpec.model_validate({"caption": "What to see.", "panels": panels}),
            overhead=None,
            sweep=sweep,
        ),
    )


def legend_of(axes: Any) -> list[str]:
    return [text.get_text() for text in axes.get_legend().get_texts()]
