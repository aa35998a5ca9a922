"""Which configs are put to several solvers.

A case of the default numerics asks what a solver makes of a scene. One with numerics of its own is
about these, and one that must fail is about what makes it fail: another solver would ask something
else there, so neither is put to several.
"""

from __future__ import annotations

from typing import Final

from lavendersim.experiment import Experiment
from lavendersim.experiment.resolve.presets import specified_numerics

# What a case may specify of its numerics and still be one of the default's: the timestep belongs to
# the scene, as its size and its speeds do.
OF_THE_SCENE: Final = frozenset({"preset", "timestep"})


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
    swept = [path for path in experiment.swept if path.startswith("numerics")]
    if own := [path for path in swept if path != "numerics.timestep"]:
        return f"varies {', '.join(own)}"
    preset, specified = specified_numerics(experiment.tree)
    own = sorted(specified.keys() - OF_THE_SCENE)
    if not specified and not experiment.tree.get("numerics", "preset"):
        return "" if preset == "default" else f"is about the numerics {preset}"
    if preset != "default":
        own.insert(0, preset)
    return f"is about numerics of its own ({', '.join(own)})" if own else ""
