"""Another solver for every cell of a config, and which configs that suits.

A case of the default numerics asks what a solver makes of a scene. One with numerics of its
own is about these, and one that must fail is about what makes it fail: another solver would ask
something else there, so neither is put to several.
"""

from __future__ import annotations

from typing import Final

from lavendersim.experiment.experiment import Experiment
from lavendersim.experiment.resolve.presets import specified_numerics, with_named_preset
from lavendersim.experiment.text.node import Node, graft

# What a case may specify of its numerics and still be one of the default's: the timestep belongs to
# the scene, as its size and its speeds do.
OF_THE_SCENE: Final = frozenset({"preset", "timestep"})


def with_solver(root: Node, solver: str) -> Node:
    """Return the tree with this solver in its numerics; everything else as it stands."""
    root = with_named_preset(root)
    numerics = root.get("numerics") or Node({}, root.mark)
    if not isinstance(numerics.content, dict):
        return root  # refused by the model, at its place
    return graft(root, ("numerics", "solver"), Node(solver, numerics.mark))


def about_something_else(experiment: Experiment) -> str:
    """Return why a case is not put to several solvers; nothing where it is.

    experiment: loaded without an override.
    """
    if any(not control.known_failure for control in experiment.controls):
        return "must fail (a negative control)"
    if experiment.mistakes:
        return f"makes a deliberate error ({', '.join(experiment.mistakes)})"
    if not experiment.expectations and experiment.always is None:
        return "judges nothing"
    swept = [path for path in experiment.swept.values() if path.startswith("numerics")]
    if own := [path for path in swept if path != "numerics.timestep"]:
        return f"varies {', '.join(own)}"
    preset, specified = specified_numerics(experiment.tree)
    own = sorted(specified.keys() - OF_THE_SCENE)
    if not specified and not experiment.tree.get("numerics", "preset"):
        return "" if preset == "default" else f"is about the numerics {preset}"
    if preset != "default":
        own.insert(0, preset)
    return f"is about numerics of its own ({', '.join(own)})" if own else ""
