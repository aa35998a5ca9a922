"""Reading configs: one frozen, validated Experiment a file, with its cells. No numba here."""

from lavendersim.cell.config import CellConfig
from lavendersim.experiment.cell import Cell
from lavendersim.experiment.experiment import Experiment
from lavendersim.experiment.load import load_experiment, load_experiment_text

__all__ = [
    "Cell",
    "CellConfig",
    "Experiment",
    "load_experiment",
    "load_experiment_text",
]
