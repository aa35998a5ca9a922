"""A run on disk: its experiment, its cells and their logs. No numba here."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lavendersim.config_options import ConfigOptions
from lavendersim.durable_files import flush_folder, write_whole
from lavendersim.errors import ConfigError, OtherVersionError, TraceError, UsageError

from .cells_index import CellsIndex, IndexRow, read_index, swept_values, with_ended
from .run_index import PENDING
from .run_seal import DONE, read_sealed, sealed
from .run_tables import read_table, renamed

if TYPE_CHECKING:
    from lavendersim.arrow import Table
    from lavendersim.cell import CellConfig
    from lavendersim.experiment import Experiment
    from lavendersim.measures.cost_table import CostTable
    from lavendersim.measures.overhead_table import OverheadTable
    from lavendersim.trace import ExpectedLog, Trace

    from .run_results import RunResults

CONFIG, RESOLVED = "config.yaml", "resolved.json"
CELLS, RESULTS, TABLE = "cells.json", "results.json", "results.csv"
OVERHEADS = "overheads.csv"
COST, COST_TABLE = "cost.json", "cost.csv"
REFINED, TIME_ERRORS = "refined", "time_errors.csv"
ENVIRONMENT, LATEST = "env.json", "latest"
# What the seal of a finished run is on.
SEALED = (CELLS, RESULTS, TABLE, CONFIG, RESOLVED, ENVIRONMENT, OVERHEADS, COST, COST_TABLE)
RUNS = Path("runs")
RESUME = "lavender run CONFIG --resume"


@dataclass(frozen=True, slots=True)
class RunCell:
    """One cell that was run, and its log."""

    index: int
    label: str
    coordinates: Mapping[str, Any]
    _folder: Path  # of many cells one: a path of its own takes half of what a cell does
    _file: str  # its log, from there
    status: str
    _config: CellConfig | None = field(default=None, repr=False, compare=False)  # where it was run
    _open: list[Trace] = field(default_factory=list, repr=False, compare=False)
    _damage: list[str] = field(default_factory=list, repr=False, compare=False)  # once looked for
    allow_incomplete: bool = False  # read what is whole of a damaged log
    expected: ExpectedLog | None = field(default=None, repr=False, compare=False)

    @property
    def path(self) -> Path:
        """Its log."""
        return self._folder / self._file

    def trace(self) -> Trace:
        """Open the cell's log; its columns are read when they are first asked for.

        TraceError where it is not whole, unless what is whole of it is allowed, and where it is not
        the log that was written of this cell.
        """
        from lavendersim.trace import open_trace  # late: runs are listed without numpy

        if not self._open:
            asked = self.allow_incomplete, self._config, self.expected
            self._open.append(open_trace(self.path, *asked))
        return self._open[0]

    def damage(self) -> str:
        """Return why the log is not all that was written of the cell; empty where it is.

        Every byte of it is read, once.
        """
        if not self._damage:
            try:
                trace = self.trace()
                trace.verify()
                self._damage.append(trace.damage)
            except TraceError as error:
                self._damage.append(str(error))
        return self._damage[0]

    @property
    def config(self) -> CellConfig:
        """Its config with every default filled in; in another process that of its log."""
        return self.trace().config if self._config is None else self._config

    def release(self) -> None:
        """Forget the columns read so far (a large sweep does not fit into memory at once)."""
        self._open.clear()


@dataclass(frozen=True)
class Run:
    """A run on disk.

    allow_incomplete: of damaged logs what is whole is read, in place of a TraceError.
    ran: the experiment, in the process that ran it; others read it and its configs from disk.
    taken: the measures of its cells by their index, there too; others take them from the logs.
    """

    path: Path
    ran: Experiment | None = field(default=None, repr=False, compare=False)
    taken: Mapping[int, Mapping[str, Any]] = field(default_factory=dict, repr=False, compare=False)
    allow_incomplete: bool = False
    # The index as this process has just written it: it is not read again.
    written: CellsIndex | None = field(default=None, repr=False, compare=False)

    @cached_property
    def experiment(self) -> Experiment:
        """The experiment as it was run. OtherVersionError where its config is not understood."""
        if self.ran is not None:
            return self.ran
        from lavendersim.experiment import load_experiment_text  # late: see `RunCell.trace`

        text = read_sealed(self.path / CONFIG)
        options = self.options._asdict()
        try:
            experiment = load_experiment_text(text, str(self.path / CONFIG), **options)
        except ConfigError as error:  # it was read when it was run
            first, more = str(error.defects[0]).partition(";")[0], len(error.defects) - 1
            others = f", and {more} more" if more else ""
            raise OtherVersionError(
                f"{first}{others}: this version does not understand the run's config"
            ) from None
        return replace(experiment, name=self.name)

    @cached_property
    def not_understood(self) -> str:
        """Why this version does not understand the config, in a sentence; empty where it does."""
        try:
            _ = self.experiment
        except OtherVersionError as error:
            return str(error)
        return ""

    @property
    def config_data(self) -> dict[str, Any]:
        """The config with its overrides, as plain data; of another version as it was written."""
        if not self.not_understood:
            return dict(self.experiment.tree.data)
        from lavendersim.experiment.load import unchecked_data  # late: see `RunCell.trace`

        overrides = dict(one.split("=", 1) for one in self.options.overrides)
        return unchecked_data(read_sealed(self.path / CONFIG)) | overrides

    @cached_property
    def name(self) -> str:
        """Name of the experiment: the stem of the file it was read from."""
        return self._index.experiment

    @property
    def question(self) -> str:
        """What the experiment asks; empty where it says nothing, and of older runs."""
        return self._index.question

    @cached_property
    def _index(self) -> CellsIndex:
        if self.written is not None:
            return self.written
        index = read_index(self.path / CELLS)
        if self.finished and not sealed(self.path) and index.has_digests:
            raise TraceError(f"{self.path / DONE}: damaged: it has lost the digests of the tables")
        return index._replace(cells=tuple(with_ended(index.cells, self.path)))

    @cached_property
    def cells(self) -> tuple[RunCell, ...]:
        """The cells that were run, in the order of the sweep."""
        known = {} if self.not_understood else {one.index: one for one in self.experiment.cells()}
        return tuple(
            RunCell(
                row.index,
                row.label,
                known[row.index].coordinates if known else swept_values(row.coordinates),
                self.path,
                row.file,
                row.status,
                known[row.index].config if self.ran is not None else None,
                allow_incomplete=self.allow_incomplete,
                expected=row.expected,
            )
            for row in self._index.cells
        )

    def damaged(self) -> list[str]:
        """Return a sentence of every log that is not all that was written; all are read."""
        found = {cell.path: cell.damage() for cell in self.cells}
        return [sentence for sentence in found.values() if sentence]

    def cut(self) -> list[str]:
        """Return a sentence of every log whose end is not that of the one written; cheap."""
        from lavendersim.trace import check_closed

        found = []
        for log, row in self.logs().items():
            try:
                check_closed(log, row.log)
            except TraceError as error:
                found.append(str(error))
        return found

    def logs(self) -> dict[Path, IndexRow]:
        """Return the logs of the cells, with their rows of the index; of cells not begun none."""
        return {
            file: row for file, row in self.rows().items() if row.status != PENDING or file.exists()
        }

    def rows(self) -> dict[Path, IndexRow]:
        """Return the rows of the index by the logs, begun or not."""
        return {self.path / row.file: row for row in self._index.cells}

    def index_rows(self) -> tuple[IndexRow, ...]:
        """Return the rows of the index, one a cell."""
        return tuple(self._index.cells)

    @property
    def options(self) -> ConfigOptions:
        """What its config was read with."""
        return self._index.options

    @property
    def finished(self) -> bool:
        """Whether the run came to its end."""
        return (self.path / DONE).exists()

    def results(self) -> RunResults:
        """Return the results as they were written. UsageError while there are none.

        TraceError where it, or the index of the run, is not as it was written.
        """
        if not self.finished:
            raise UsageError(
                f"{self.path}: this run did not finish; its logs are in cells/, and "
                f"`{RESUME}` goes on with it"
            )
        from .run_results import read_results  # late: see `RunCell.trace`

        path = self.path / RESULTS
        results = read_results(path)
        found, known = (
            [(row.index, row.label, row.status) for row in rows]
            for rows in (results.cells, self._index.cells)
        )
        if found != known:
            raise TraceError(f"{path}: damaged: it has other cells than {CELLS}")
        return results

    def table(self, name: str) -> Table:
        """Return `cells`, `verdicts`, or of all logs `step`, `pose`, `velocity` or `contact`.

        Arrow, pandas, polars and DuckDB read it. UsageError for another name, or where there is
        none.
        """
        from .export import table_of  # late: see `RunCell.trace`

        return table_of(self, name)

    def _repr_html_(self) -> str:
        """Return the run as a notebook shows it."""
        from lavendersim.figures.notebook import html_of  # late: see `RunCell.trace`

        return html_of(self)

    def overheads(self) -> OverheadTable | None:
        """Return what each effect costs, where it was taken; UsageError while it is not finished.

        TraceError where its table is damaged.
        """
        if (data := self.results().overheads) is None:
            return None
        from lavendersim.measures.overhead_table import OverheadTable  # late: see `RunCell.trace`

        try:
            return OverheadTable.of(dict(data))
        except (ValueError, KeyError, TypeError) as error:
            raise TraceError(f"{self.path / RESULTS}: damaged: overheads: {error}") from None

    def cost(self) -> CostTable | None:
        """Return what accuracy costs, where it was taken; UsageError while it is not finished.

        TraceError where its table is damaged.
        """
        self.results()
        path = self.path / COST
        if not path.exists():
            return None
        from lavendersim.measures.cost_table import CostTable  # late: see `RunCell.trace`

        try:
            return CostTable.of(renamed(read_table(path, "rows"), "rows"))
        except ValueError as error:
            raise TraceError(f"{path}: damaged: {error}") from None


def is_run_directory(path: Path) -> bool:
    """Whether `path` is what a run left (its config files are copies, not experiments)."""
    return (path / CELLS).exists()


def list_runs(root: Path = RUNS) -> list[Run]:
    """Return the runs below `root`, oldest first."""
    if not root.is_dir():
        return []
    folders = (path.parent for path in root.glob(f"[!.]*/{CELLS}"))  # a hidden one is being removed
    return sorted(map(Run, (one for one in folders if not one.is_symlink())), key=_name)


def _name(run: Run) -> str:
    return run.path.name


def open_run(
    path: Path | str | None = None, root: Path = RUNS, allow_incomplete: bool = False
) -> Run:
    """Open a run by its directory or name; without one, the latest finished run.

    allow_incomplete: of damaged logs what is whole is read; see `Trace.damage`.
    Raises UsageError when there is none.
    """
    if path is None:
        finished = [run for run in list_runs(root) if run.finished]
        if not finished:
            raise UsageError(f"{root} has no finished run: start one with `lavender run CONFIG`")
        latest = root / LATEST
        named = latest.read_text(encoding="utf-8").strip() if latest.is_file() else ""
        if latest.is_symlink():
            named = os.readlink(latest)
        found = next((run for run in finished if run.path.name == named), finished[-1])
        return replace(found, allow_incomplete=allow_incomplete)
    for candidate in (Path(path), root / path):
        if (candidate / CELLS).exists():
            return Run(candidate, allow_incomplete=allow_incomplete)
    raise UsageError(f"{path}: not the directory of a run (it has no {CELLS})")


def check_latest(root: Path) -> None:
    """Raise UsageError where `latest` is no link that could be moved: before a run, not after."""
    latest = root / LATEST
    if latest.is_dir() and not latest.is_symlink():
        raise UsageError(
            f"{latest}: a directory; the link to the newest run stands there, so name it otherwise"
        )


def point_latest(directory: Path, root: Path) -> None:
    """Move the `latest` link to a finished run in one step."""
    temporary = root / f".{LATEST}-{os.getpid()}"
    for left in root.glob(f".{LATEST}-*"):  # of a process that was killed between two calls
        if left == temporary or not is_running(left.name.rpartition("-")[2]):
            left.unlink(missing_ok=True)
    try:
        temporary.symlink_to(directory.name, target_is_directory=True)
    except OSError:  # where links need a privilege, a file holds the name
        write_whole(root / LATEST, directory.name + "\n")
        return
    try:
        os.replace(temporary, root / LATEST)
    finally:
        temporary.unlink(missing_ok=True)
    flush_folder(root)


def is_running(process: str) -> bool:
    """Whether a process of this number runs; where that cannot be asked, it may."""
    if os.name != "posix" or not process.isdecimal():
        return True
    try:
        os.kill(int(process), 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        pass
    return True
