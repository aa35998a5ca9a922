"""Loading a config file: an Experiment, or a ConfigError with every defect of the file.

The outline: text -> tree, over those that it extends -> axes -> every cell's tree -> models and
checks. Checks work on trees, so that a defect in one section hides none in another.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

from lavendersim.config_options import ConfigOptions
from lavendersim.errors import ConfigError, UsageError
from lavendersim.experiment.cell import Cell, build_cell
from lavendersim.experiment.checks.reading import Reading
from lavendersim.experiment.experiment import Experiment
from lavendersim.experiment.inheritance.parents import with_parents
from lavendersim.experiment.mesh_files import refuse_mesh_files, with_mesh_files
from lavendersim.experiment.models.experiment import ExperimentConfig
from lavendersim.experiment.models.tree import swept_values
from lavendersim.experiment.own_measures import with_own_measures
from lavendersim.experiment.resolve.formulas import with_numbers
from lavendersim.experiment.sweeps import axes as sweep
from lavendersim.experiment.sweeps.numbers_of_bodies import is_valid, varies_numbers
from lavendersim.experiment.sweeps.option_overrides import SET, check_untouched, with_overrides
from lavendersim.experiment.sweeps.reduced_length import at_reduced_length, check_reduced_length
from lavendersim.experiment.sweeps.solver_override import with_solver
from lavendersim.experiment.text.file import read_file
from lavendersim.experiment.text.former import with_new_spellings
from lavendersim.experiment.text.node import Node, key_mark
from lavendersim.experiment.text.parse import decode, parse
from lavendersim.experiment.text.report import Report
from lavendersim.garbage import uncollected
from lavendersim.quantities.found import found

# Checking a cell takes 0.3 ms. Of larger sweeps every axis is checked value by value up to as many
# cells, and beyond them where bodies start, by its type alone. What is left is checked when its
# cell, or the first one like it, is built for a plan: before anything runs.
MOST_CELLS_CHECKED = 1000


def load_experiment(
    config: str | os.PathLike[str] | Mapping[str, Any],
    reduced: bool = False,
    solver: str | None = None,
    overrides: Sequence[str] | Mapping[str, Any] = (),
) -> Experiment:
    """Read and validate one config; reduced: a slow experiment at its reduced length.

    config: path of its file, its text (of more than one line), or the mapping that the file would
    hold; messages call what has no file `config`.
    solver: in every cell, instead of what the config says; None leaves it as it stands.
    overrides: values instead of those of the config, a mapping by path, or
    texts as `sweeps.option_overrides` reads them: `set numerics.timestep=1/480`.

    Raises ConfigError with all defects of the config, UsageError when it cannot be read.
    """
    if isinstance(overrides, Mapping):
        overrides = [f"{SET}{path}={_plain(value)}" for path, value in overrides.items()]
    if isinstance(config, Mapping):
        config = json.dumps(config, indent=1, default=_without_json) + "\n"
    if isinstance(config, str) and "\n" in config:
        return load_experiment_text(config, "config", reduced, solver, overrides)
    file = Path(config)
    raw, size = read_file(file, str(file))
    return _load(raw, str(file), size, ConfigOptions(reduced, solver, tuple(overrides)), file)


def _plain(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value, default=_without_json)


def _without_json(value: Any) -> Any:
    """Return what YAML has for a value of Python: lists for arrays, `1/480` for a Fraction."""
    if isinstance(value, Fraction | os.PathLike):
        return str(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    raise UsageError(f"config: {found(value)} has no place in a config")


def load_experiment_text(
    text: str | bytes,
    name: str,
    reduced: bool = False,
    solver: str | None = None,
    overrides: Sequence[str] = (),
    divisor: int = 1,
) -> Experiment:
    """Validate a config given as text; `name` stands for the file in messages.

    The rest by the names of `ConfigOptions`: `**run.options._asdict()` reads it as a run did.
    """
    raw = text.encode("utf-8", "surrogatepass") if isinstance(text, str) else text
    options = ConfigOptions(reduced, solver, tuple(overrides))
    experiment = _load(raw, name, len(raw), options)
    return experiment if divisor == 1 else experiment.refined(divisor)


def unchecked_data(raw: bytes) -> dict[str, Any]:
    """Return what a config says, as plain data, where no more than YAML is asked of it."""
    root = parse(raw, Report("config"), len(raw))
    return dict(root.data) if root is not None and isinstance(root.data, dict) else {}


def _load(
    raw: bytes, name: str, size: int, options: ConfigOptions, file: Path | None = None
) -> Experiment:
    """file: that the text is of, where it may speak of others beside it."""
    report = Report(name)
    root = parse(raw, report, size)
    if root is None:
        raise ConfigError(report.defects)
    if not isinstance(root.content, dict):
        sentence = f"expected a mapping with scene and duration, found {found(root.data)}"
        report.add(root.mark, sentence)
        raise ConfigError(report.defects)
    root, text, known = with_new_spellings(root, name), decode(raw), len(report.defects)
    if file is not None:
        root, text = _with_files(root, text, file, report)
    else:
        refuse_mesh_files(root, report)
    if len(report.defects) > known:  # of files beside this one: what it has is not known
        raise ConfigError(report.defects)
    root = tree = with_overrides(root, options.overrides, report)
    if not report.close_round():
        raise ConfigError(report.defects)
    root, computed = with_numbers(root, report)
    check_reduced_length(root, report)
    root, shortened = at_reduced_length(root) if options.reduced else (root, False)
    root = with_solver(root, options.solver) if options.solver is not None else root
    axes = sweep.axes_of(root, report)
    check_untouched(root, axes, report)
    config = _check_first(root, axes, report)
    cells = sweep.count(axes)
    if cells > sweep.MOST_CELLS:
        sentence = f"sweep: {cells} cells, expected at most {sweep.MOST_CELLS}"
        report.add(key_mark(root, "sweep"), sentence)
        raise ConfigError(report.defects)
    sweep.check_distinct(axes, report)
    with uncollected():  # cells stay
        made = _check_others(root, axes, cells, report, name)
    if report.defects or config is None:
        raise ConfigError(report.defects)
    values = {
        axis: tuple(dict.fromkeys(sweep.swept_value(node.data) for node in nodes))
        for axis, nodes in swept_values(root).items()
    }
    path, options = Path(name), options._replace(reduced=shortened)
    return Experiment(path.stem, path, text, config, values, tree, made, options, tuple(computed))


def _with_files(root: Node, text: str, file: Path, report: Report) -> tuple[Node, str]:
    """Return a tree and its text with what files have that it extends, or that stand beside it."""
    head, files = "", {report.name: file}
    if (whole := with_parents(root, file, report.name, report)) is not None:
        root, text, files = whole.tree, whole.text, {**whole.files, **files}
        head = text[: text.find("\n") + 1]
    if (meshes := with_mesh_files(root, files, report)) is not None:
        root, text = meshes[0], head + meshes[1]
        head += meshes[1][: meshes[1].find("\n") + 1]
    if (own := with_own_measures(root, files, report)) is not None:
        root, text = own[0], head + own[1]
    return root, text


def _check_first(root: Node, axes: sweep.Products, report: Report) -> ExperimentConfig | None:
    """Check the whole file, with the first value of every axis in its place."""
    tree = next(sweep.points(axes), sweep.SweepPoint(())).tree(root, report)
    config = Reading(tree, swept_values(root), report).read(ExperimentConfig)
    report.close_round()
    return config


def _check_others(
    root: Node, axes: sweep.Products, count: int, report: Report, name: str
) -> tuple[Cell, ...]:
    """Check the cells one by one and return them all; those that were built keep their config."""
    if report.defects or count > MOST_CELLS_CHECKED:
        for number, (axis, point) in enumerate(sweep.covering_points(axes)):
            if number < MOST_CELLS_CHECKED or not (
                axis is None or not varies_numbers(axis) or is_valid(point, axis, root)
            ):
                build_cell(root, point, report)
    cells: list[Cell] = []
    if report.defects:
        return ()
    for index, point in enumerate(sweep.points(axes)):
        cell = Cell(index, root, point, name)
        if count <= MOST_CELLS_CHECKED:
            config = build_cell(root, point, report)
            if config is not None:
                cell.keep(config)
        cells.append(cell)
    return tuple(cells)
