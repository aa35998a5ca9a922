"""Registration of panels: the model of a kind's config, and the function that draws it.

class Cumulative(Panel):             # its part of the config
    kind: Literal["cumulative"]
    ...

@draws(Cumulative)                   # what its panel shows
def draw_cumulative(
    axes: Axes, panel: Cumulative, cells: Sequence[Cell], values: Values, experiment: Experiment
) -> None:
    ...

Title, labels, scales, levels, limits and legend of a panel are drawn for it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeVar

from lavendersim.figures.specs.base import Panel

Draw = TypeVar("Draw", bound=Callable[..., None])

# What draws each kind of panel, by the model of its config.
FUNCTIONS: Final[dict[type[Panel], Callable[..., None]]] = {}


def draws(model: type[Panel]) -> Callable[[Draw], Draw]:
    """Register the decorated function as what draws a kind of panel.

    It takes matplotlib's axes, the panel, the cells that it shows, their measures' values and the
    experiment.
    """

    def register(function: Draw) -> Draw:
        if FUNCTIONS.setdefault(model, function) is not function:
            raise ValueError(f"{model.__name__} is drawn already")
        return function

    return register
