"""The results of a run, `results.json`, as typed records: read and written here and nowhere else.

A row of a cell says how it ended, what was measured of it, what its steps cost and how well they
were solved. Numbers are numbers: the file, which has only those of JSON, has a text in place of NaN
and the infinities.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Final, TypeVar, cast

from lavendersim.durable_files import write_in_pieces
from lavendersim.errors import TraceError
from lavendersim.measures.verdict import Verdict

from .json_table import finite
from .limits_reached import AT_LIMIT
from .run_tables import read_table, renamed

NOT_FINITE: Final = {"nan": math.nan, "inf": math.inf, "-inf": -math.inf}
# Columns of the violations: the largest of each kind in any step, and the bodies whose contact has
# it. What an older version did not write, and what is not logged, is missing or None.
WORST: Final = "worst_"
Plain = TypeVar("Plain", int, str, bool)
KINDS: Final = {int: "count", str: "text", bool: "yes or no"}
LONGEST_SHOWN: Final = 40  # characters of what is refused


@dataclass(frozen=True, slots=True)
class CellResult:
    """What a run says of one of its cells."""

    index: int  # in the sweep
    label: str
    status: str  # `complete`, or why not
    steps: int
    measures: Mapping[str, Any]  # by name: a number, a row of numbers, or why there is none
    physics_us_per_step: float  # [us]
    logging_us_per_step: float  # [us]
    compile_s: float  # composing, compiling and loading its kernels [s]
    tolerance: float | None  # that the config asks of a step [m/s]; None: all sweeps are taken
    worst_residual: (
        float  # of any step [m/s]; NaN where another engine or an older version has none
    )
    not_converged_steps: int | None  # that ended above the tolerance; None: likewise
    violations: Mapping[str, float | str | None] = field(default_factory=dict)  # by WORST columns
    # How often an algorithm took all its iterations, by columns of /step; none where it never did.
    at_limit: Mapping[str, int] = field(default_factory=dict)

    @property
    def as_json(self) -> dict[str, Any]:
        """The row as the file has it."""
        plain: dict[str, Any] = finite(self.row, str)
        return plain

    @property
    def row(self) -> dict[str, Any]:
        """The same with numbers that JSON does not have."""
        return {
            "index": self.index,
            "label": self.label,
            "status": self.status,
            "steps": self.steps,
            "measures": dict(self.measures),
            "physics_us_per_step": self.physics_us_per_step,
            "logging_us_per_step": self.logging_us_per_step,
            "compile_s": self.compile_s,
            "tolerance": self.tolerance,
            "worst_residual": self.worst_residual,
            "not_converged_steps": self.not_converged_steps,
            **self.violations,
            **self.at_limit,
        }


@dataclass(frozen=True)
class RunResults(Mapping[str, Any]):
    """The results of a run.

    By key (`results["cells"][0]["measures"]`) it gives what the file has, as plain data.
    """

    experiment: str  # the stem of the file that it was read from
    reduced: bool  # whether slow cells were run at their reduced length
    solver: str | None  # in place of the config's; None: the config's own
    cells: Sequence[CellResult]  # in the order of the sweep
    compile_s: float | None  # of the whole run, whose cells share kernels [s]
    checks: Sequence[Verdict]
    passed: bool  # whether every claim was met and every cell completed that should
    overheads: Mapping[str, Any] | None = None  # as JSON has them, see `Run.overheads`

    @cached_property
    def as_json(self) -> dict[str, Any]:
        """The table as the file has it."""
        table = dict(self._pieces())
        return table | {
            name: [finite(row, str) for row in table[name]] for name in ("cells", "checks")
        }

    def _pieces(self) -> Iterator[tuple[str, Any]]:
        """Yield the entries of the table; rows are made while they are written, NaN is in them."""
        yield "experiment", self.experiment
        yield "reduced", self.reduced
        yield "solver", self.solver
        yield "cells", (row.row for row in self.cells)
        if self.compile_s is not None:
            yield "compile_s", self.compile_s
        yield "checks", (verdict.row for verdict in self.checks)
        yield "passed", self.passed
        if self.overheads is not None:
            yield "overheads", finite(dict(self.overheads), str)

    def __getitem__(self, key: str) -> Any:
        """Return an entry of the file, as plain data."""
        return self.as_json[key]

    def __iter__(self) -> Iterator[str]:
        """Yield the keys of the file."""
        return iter(self.as_json)

    def __len__(self) -> int:
        """Return how many keys the file has."""
        return len(self.as_json)

    def mean_per_step(self, column: str) -> float:
        """Return the mean cost of a step [us] over all steps of all cells; NaN without one."""
        steps = sum(row.steps for row in self.cells)
        total = sum(row.steps * getattr(row, column) for row in self.cells)
        return total / steps if steps else math.nan

    def write(self, path: Path) -> None:
        """Write the table; numbers keep all their digits."""
        from .json_table import pieces_of  # late: who lists runs writes none

        write_in_pieces(path, pieces_of(dict(self._pieces()), str), flush=False)


def read_results(path: Path) -> RunResults:
    """Return the results of a finished run. TraceError where they are damaged."""
    table = renamed(read_table(path, "cells", ("index", "label", "status", "measures")), "cells")
    try:
        if not isinstance(table["passed"], bool):
            raise TypeError(f"passed is no yes or no: {table['passed']!r}")
        return RunResults(
            str(table["experiment"]),
            bool(table.get("reduced", False)),
            table.get("solver"),
            tuple(map(_cell_of, table["cells"])),
            table.get("compile_s"),
            tuple(map(_verdict_of, table["checks"])),
            table["passed"],
            table.get("overheads"),
        )
    except KeyError as error:
        raise TraceError(f"{path}: damaged: it has no {error}") from None
    except (ValueError, TypeError, AttributeError) as error:
        raise TraceError(f"{path}: damaged: {error}") from None


def as_numbers(value: Any) -> Any:
    """Return what was measured with numbers in place of the texts that the file has for them."""
    if isinstance(value, str):
        return NOT_FINITE.get(value, value)
    if isinstance(value, list):
        return [as_numbers(item) for item in value]
    return value


def _cell_of(row: Mapping[str, Any]) -> CellResult:
    columns = {name: as_numbers(value) for name, value in row.items() if name.startswith(WORST)}
    columns.pop("worst_residual", None)
    tolerance, not_converged = row.get("tolerance"), row.get("not_converged_steps")
    return CellResult(
        _of_kind(row, "index", int),
        _of_kind(row, "label", str),
        _of_kind(row, "status", str),
        int(row["steps"]),
        {name: as_numbers(value) for name, value in row["measures"].items()},
        float(row["physics_us_per_step"]),
        float(row["logging_us_per_step"]),
        float(row["compile_s"]),
        # Before 0.1.0 steps had no residual: what was not recorded is not known, and not zero.
        None if tolerance is None else float(tolerance),
        float(row.get("worst_residual", "nan")),
        None if not_converged is None else int(not_converged),
        columns,
        {name: int(row[name]) for name in AT_LIMIT if name in row},
    )


def _verdict_of(row: Mapping[str, Any]) -> Verdict:
    known = {"path": "", "follows": False, "judged": True, **row}  # older versions wrote fewer
    return Verdict(
        _of_kind(row, "name", str),
        _of_kind(row, "node", str),
        _of_kind(row, "passed", bool),
        float(row["measured"]),
        _of_kind(row, "expected", str),
        _of_kind(row, "tolerance", str),
        own_message=_of_kind(row, "message", str),
        path=_of_kind(known, "path", str),
        follows=_of_kind(known, "follows", bool),
        margin=float(row.get("margin", "nan")),
        judged=_of_kind(known, "judged", bool),
    )


def _of_kind(row: Mapping[str, Any], name: str, kind: type[Plain]) -> Plain:
    """Return a value of a row; TypeError where it is of another kind: yes is not 1."""
    if type(row[name]) is not kind:
        raise TypeError(f"{name} is no {KINDS[kind]}: {str(row[name])[:LONGEST_SHOWN]!r}")
    return cast(Plain, row[name])
