"""A cost section with fewer settings, overheads of fewer effects, both in the fewest rounds.

Ends of a grid stay: the coarsest and the finest are what its curves are read by.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final, TypeVar

from lavendersim.experiment.experiment import Experiment
from lavendersim.experiment.models.cost import FEWEST_REPEATS, CostSpec
from lavendersim.experiment.models.overhead import REQUIRED, OverheadSpec

T = TypeVar("T")
_LISTS: Final = ("timesteps", "sweeps", "tolerances", "accuracies")


def quick(experiment: Experiment) -> Experiment:
    """Return the experiment with every other value of its cost grid, and the fewest rounds.

    Of overheads those of the effects that the scene requires, where all are asked for.
    """
    config = experiment.config
    if config.cost is not None:
        config = config.model_copy(update={"cost": coarser(config.cost)})
    if config.overhead is not None:
        config = config.model_copy(update={"overhead": shorter(config.overhead)})
    return replace(experiment, config=config)


def coarser(spec: CostSpec) -> CostSpec:
    """Return every other value of each list from its first on, and its last."""
    lists = {name: thinned(getattr(spec, name)) for name in _LISTS}
    return spec.model_copy(update={**lists, "repeats": FEWEST_REPEATS})


def shorter(spec: OverheadSpec) -> OverheadSpec:
    """Return the overheads of what is named, or of what the scene requires."""
    effects = REQUIRED if spec.effects == "all" else spec.effects
    return spec.model_copy(
        update={"effects": effects, "repeats": min(spec.repeats, FEWEST_REPEATS)}
    )


def thinned(values: tuple[T, ...]) -> tuple[T, ...]:
    """Return every other value, and the last."""
    last = len(values) - 1
    return tuple(one for place, one in enumerate(values) if place % 2 == 0 or place == last)
