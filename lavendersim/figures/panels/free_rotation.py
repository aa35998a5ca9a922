"""Angular velocity of a free body against time, in its own axes, on Jacobi's exact solution."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from lavendersim.figures.drawing import draw_ideal
from lavendersim.figures.registration import draws
from lavendersim.figures.specs.free_rotation import FreeRotation
from lavendersim.figures.style import look
from lavendersim.measures.interfaces import Cell
from lavendersim.measures.kinds.spinning import body_rates, exact_rotation, times
from lavendersim.measures.values import Values

POINTS = 1200  # of the exact solution


@draws(FreeRotation)
def draw_panel(
    axes: Any, panel: FreeRotation, cells: Sequence[Cell], values: Values, experiment: Any
) -> None:
    """Draw one panel onto the axes; of several cells the first."""
    if not cells:
        return
    trace = cells[0].trace()
    moving = trace.config.scene.bodies[panel.body]
    time, rates = times(trace), body_rates(trace, panel.body)
    fine = np.linspace(time[0], time[-1], POINTS)
    exact = exact_rotation(moving).angular_velocity(fine)
    chosen = np.linspace(0, len(time) - 1, panel.markers).astype(int)
    for axis, name in enumerate("xyz"):
        draw_ideal(axes, fine, exact[:, axis], "Jacobi" if axis == 0 else None)
        axes.plot(
            time[chosen],
            rates[chosen, axis],
            linestyle="none",
            color=look(axis).colour,
            marker=look(axis).marker,
            markersize=4.5,
            markeredgecolor="white",
            markeredgewidth=0.5,
            label=f"about {name}",
            zorder=3,
        )
