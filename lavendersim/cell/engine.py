"""Which engine simulates a cell, where it is another than lavender's."""

from __future__ import annotations

from lavendersim.quantities.model import ResolvedModel


class CellEngine(ResolvedModel):
    """One set of settings of an engine."""

    name: str  # of its variant, such as `mujoco-stiff`
    settings: dict[str, bool | int | float | str]  # that differ from the engine's own
