"""Reading configs: one frozen, validated Experiment a file, with its cells. No numba here."""

from lavendersim.cell.config import CellConfig
from lavendersim.experiment.cell import Cell
from lavendersim.experiment.experiment import Experiment
from lavendersim.experiment.load import load_experiment, load_experiment_text
from lavendersim.experiment.models.tree import body_path, described, immovable
from lavendersim.experiment.text.node import Mark, Node, key_mark

__all__ = [
    "Cell",
    "CellConfig",
    "Experiment",
    "Mark",
    "Node",
    "body_path",
    "described",
    "immovable",
    "key_mark",
    "load_experiment",
    "load_experiment_text",
]
