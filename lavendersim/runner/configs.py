"""The configs among files and folders, read before anything is run: all defects of all files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from lavendersim.errors import ConfigError, Defect, UsageError
from lavendersim.experiment import Experiment, load_experiment
from lavendersim.lint import warn

from .checks import check
from .run_directory import is_run_directory

BASE: Final = "_"  # a config's name begins with it that is no experiment by itself


def find_configs(paths: list[Path]) -> list[Path]:
    """Return the config files among `paths`; a folder stands for its *.yaml files, in order.

    But for those whose name begins with `_`: they are there to be extended.

    Raises UsageError when a path does not exist or a folder holds none.
    """
    found: list[Path] = []
    for path in paths:
        if path.is_dir():
            inside = [
                file
                for file in sorted([*path.rglob("*.yaml"), *path.rglob("*.yml")])
                if not is_run_directory(file.parent) and not file.name.startswith(BASE)
            ]
            if not inside:
                raise UsageError(f"{path}: no *.yaml file in this folder")
            found += inside
        elif path.exists():
            found.append(path)
        else:
            raise UsageError(f"{path}: no such file or folder")
    return list(dict.fromkeys(found))


def load_all(
    paths: list[Path], reduced: bool = False, overrides: Sequence[str] = (), strict: bool = False
) -> list[Experiment]:
    """Load every config among `paths`; raises ConfigError with the defects of all files.

    reduced: slow experiments at their reduced length. overrides: see `load_experiment`.
    strict: what is suspicious is a defect, too, not a warning; see `lint`.

    Among them are effects switched by hand that cannot be: the plan of the scene decides.
    """
    experiments: list[Experiment] = []
    defects: list[Defect] = []
    for path in find_configs(paths):
        try:
            experiment = load_experiment(path, reduced, overrides=overrides)
            check(experiment)
            warn(experiment, strict)
            experiments.append(experiment)
        except ConfigError as error:
            defects += error.defects
    if defects:
        raise ConfigError(defects)
    return experiments
