"""Pages of one panel over cells whose measure is given: what panels over sweeps are drawn of."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from matplotlib import style
from synthetic import SyntheticCell, ball_and_floor, trace_of

from lavendersim.figures.config_figure import compose
from lavendersim.figures.specs.catalogue import FigureSpec
from lavendersim.figures.style import STYLE
from lavendersim.measures.specs.impact import ImpactImpulse

LABELS = {"title": "one idea", "x_label": "ratio [-]", "y_label": "solver"}


def cell(coordinates: dict[str, Any], impulse: float, status: str = "complete") -> SyntheticCell:
    """A cell whose measure is a given impulse."""
    log = trace_of([0.0] * 4, [(2, impulse, 1e-4)], resolved=ball_and_floor(position=[0, 0, 0.1]))
    log.status = status
    return SyntheticCell(coordinates, log)


def page(panel: dict[str, Any], cells: list[SyntheticCell], *more: dict[str, Any]) -> Any:
    experiment = SimpleNamespace(
        name="some_experiment",
        measures={"impulse": ImpactImpulse(kind="impact_impulse", body="ball")},
        config=SimpleNamespace(
            question="What is asked?",
            figure=FigureSpec.model_validate({"caption": "See.", "panels": (panel, *more)}),
            overhead=None,
            sweep={},
        ),
    )
    with style.context(STYLE, after_reset=True):
        return compose(experiment, cells)
