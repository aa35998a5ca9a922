"""Runs experiments from config to verdict, and keeps runs on disk."""

from .experiment_run import Finished, Progress, find_configs, load_all, run
from .run_directory import RUNS, Run, RunCell, list_runs, open_run

__all__ = [
    "RUNS",
    "Finished",
    "Progress",
    "Run",
    "RunCell",
    "find_configs",
    "list_runs",
    "load_all",
    "open_run",
    "run",
]
