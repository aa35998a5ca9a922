"""Every case run by every solver: the entries of a matrix, as they finish.

Every entry is a run of its own, in a directory of its own, made in another process: a case that
breaks its process off loses nothing else. Solver by solver, so that what an interrupted matrix
leaves are whole columns.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple, get_args

from lavendersim.cell.choices import Solver
from lavendersim.errors import ConfigError, UsageError
from lavendersim.experiment import Experiment, load_experiment
from lavendersim.peers import catalogue
from lavendersim.quantities.found import nearest, quoted

from .experiment_run import run
from .matrix_entry import DIED, REFUSED, Entry, entry_of, with_counts, without_run
from .run_directory import RUNS
from .solver_cases import about_something_else
from .step_counts import counts_of
from .workers import Death, work

ALL = "all"


class Case(NamedTuple):
    """A config that is put to every solver."""

    name: str  # `tall/jenga`: its folder and its file
    path: Path
    reduced: bool  # a slow one, at its reduced length
    question: str


class CaseAndSolver(NamedTuple):
    """What one process does at a time."""

    case: Case
    solver: str
    root: Path  # where run directories are made


def chosen(names: Sequence[str]) -> tuple[str, ...]:
    """Return the solvers that are meant, each once, `all` with the default's first.

    names: with commas between, or several. UsageError with the nearest name for one unknown.
    """
    valid = sorted(get_args(Solver), key=lambda name: name != "adaptive")
    found: dict[str, None] = {}
    for name in (part.strip() for text in names for part in text.split(",")):
        if name != ALL and name not in valid:
            raise UsageError(f"no solver is called {quoted(name)}{nearest(name, [*valid, ALL])}")
        found.update(dict.fromkeys(valid if name == ALL else [name]))
    return tuple(found)


def cases_of(experiments: Sequence[Experiment]) -> tuple[list[Case], dict[str, str]]:
    """Return what is put to every solver, and of every other config why it is not."""
    cases: list[Case] = []
    left_out: dict[str, str] = {}
    for experiment in experiments:
        name = _name(experiment.path)
        if why := about_something_else(experiment):
            left_out[name] = why
            continue
        if any(case.name == name for case in cases):
            name = str(experiment.path)
        reduced, question = experiment.options.reduced, experiment.config.question
        cases.append(Case(name, experiment.path, reduced, question))
    return cases, left_out


def make_entry(pair: CaseAndSolver) -> Entry:
    """Run a case by a solver and return its entry; whatever happens there is its verdict."""
    return _entry(pair, lambda case: load_experiment(case.path, case.reduced, pair.solver))


def make_engine_entry(pair: CaseAndSolver, more: Sequence[str] = ()) -> Entry:
    """Run a case by an engine, whose name stands in the place of a solver's; more: overrides."""
    given = [*catalogue.overrides_of([pair.solver]), *more]
    return _entry(
        pair, lambda case: load_experiment(case.path, case.reduced, overrides=given), counted=True
    )


def _entry(pair: CaseAndSolver, load: Callable[[Case], Experiment], counted: bool = False) -> Entry:
    case, solver = pair.case.name, pair.solver
    try:
        experiment = load(pair.case)
        finished = run(experiment, pair.root, overheads=False)
        entry = entry_of(case, solver, finished)
        return with_counts(entry, counts_of(finished.run.cells)) if counted else entry
    except ConfigError as error:
        return without_run(case, solver, REFUSED, error.defects[0].message)
    except UsageError:
        raise  # true of every entry
    except Exception as error:
        # a defect of lavender; the other entries are still worth having
        died = without_run(case, solver, DIED, f"{type(error).__name__}: {error}")
        return died._replace(detail=traceback.format_exc())


def entries(
    cases: Sequence[Case],
    solvers: Sequence[str],
    root: Path = RUNS,
    jobs: int = 1,
    make: Callable[[CaseAndSolver], Entry] = make_entry,
) -> Iterator[Entry]:
    """Yield the entry of every case and solver when it is done, solver by solver.

    jobs: entries that are made at once, each in a process; their logs are the same for any number.
    make: what one process does.
    """
    for solver in solvers:
        # a process for each solver holds its kernels and no others
        pairs = [CaseAndSolver(case, solver, root) for case in cases]
        for pair, made in work(make, pairs, jobs):
            if isinstance(made, Death):
                yield without_run(pair.case.name, pair.solver, DIED, f"its process {made.how}")
            else:
                yield made


def _name(path: Path) -> str:
    return f"{path.absolute().parent.name}/{path.stem}"
