"""The declarations of all solvers, by name."""

from __future__ import annotations

from importlib import import_module
from typing import Final

from . import SOLVER_NAMES
from .solver import Solver

SOLVERS: Final[dict[str, Solver]] = {
    name: import_module(f".{name}", __package__).SOLVER for name in SOLVER_NAMES
}
