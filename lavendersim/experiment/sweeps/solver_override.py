"""Another solver for every cell of a config."""

from __future__ import annotations

from lavendersim.experiment.resolve.presets import with_named_preset
from lavendersim.experiment.text.node import Node, graft


def with_solver(root: Node, solver: str) -> Node:
    """Return the tree with this solver in its numerics; everything else as it stands."""
    root = with_named_preset(root)
    numerics = root.get("numerics") or Node({}, root.mark)
    if not isinstance(numerics.content, dict):
        return root  # refused by the model, at its place
    return graft(root, ("numerics", "solver"), Node(solver, numerics.mark))
