"""Which engines a cost grid has: those that are asked for and can do the scene."""

from __future__ import annotations

from collections.abc import Sequence

from lavendersim.errors import ConfigError
from lavendersim.experiment import Experiment
from lavendersim.experiment.sweeps.cost_grid import over_the_grid, settings_of
from lavendersim.peers.catalogue import LAVENDER


def able_engines(
    experiment: Experiment, engines: Sequence[str]
) -> tuple[tuple[str, ...], dict[str, str]]:
    """Return the engines that can do a scene, and why the others cannot; none: the config's own.

    Raises the ConfigError of the first where none can.
    """
    own = experiment.cells()[0].config.engine
    asked = tuple(engines) or (LAVENDER if own is None else own.name,)
    if asked == (LAVENDER,):
        return asked, {}
    refused: dict[str, ConfigError] = {}
    for engine in asked:
        try:
            over_the_grid(experiment, settings_of(experiment, (engine,))).cells()
        except ConfigError as error:
            refused[engine] = error
    able = tuple(engine for engine in asked if engine not in refused)
    if not able:
        raise next(iter(refused.values()))
    return able, {engine: error.defects[0].message for engine, error in refused.items()}
