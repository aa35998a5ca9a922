"""Runs experiments from config to verdict, and keeps runs on disk; names are imported when used.

To list or open runs needs neither the models of a config nor numpy; to run needs the whole line.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .configs import find_configs, load_all
    from .experiment_run import Finished, run
    from .progress import Progress
    from .resume import finished_run
    from .run_directory import RUNS, Run, RunCell, list_runs, open_run

_HOME = {
    "RUNS": "run_directory",
    "Finished": "experiment_run",
    "Progress": "progress",
    "Run": "run_directory",
    "RunCell": "run_directory",
    "find_configs": "configs",
    "finished_run": "resume",
    "list_runs": "run_directory",
    "load_all": "configs",
    "open_run": "run_directory",
    "run": "experiment_run",
}

__all__ = [
    "RUNS",
    "Finished",
    "Progress",
    "Run",
    "RunCell",
    "find_configs",
    "finished_run",
    "list_runs",
    "load_all",
    "open_run",
    "run",
]


def __getattr__(name: str) -> Any:
    """Import a public name from its module."""
    if name in _HOME:
        return getattr(import_module(f"lavendersim.runner.{_HOME[name]}"), name)
    raise AttributeError(f"module 'lavendersim.runner' has no attribute {name!r}")
