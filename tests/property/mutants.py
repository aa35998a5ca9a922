"""Mutants of the engine: one line of a kernel broken at a time, and which tests see it.

    python -m tests.property.mutants --count 300 --seed 1 --keep mutants.csv
    python -m tests.property.mutants --count 20 --only 'effects/*' 'step.py'
    python -m tests.property.mutants --count 300 --seed 1 --keep mutants.csv --compiled

Each mutant changes a sign, a factor, an index or a count by one, or turns a comparison round. Tests
are collected once, and run once with kernels in Python's interpreter, to know which lines each
reaches: some minutes, kept beside `--keep`. On a mutant run those that reach its line, in a fork
whose kernels are interpreted, too, from the quickest on, until one fails: the mutant is seen, at a
second or two. They are a part of the suite: what they do not see, the whole suite may.
`--compiled` tries what they did not see on compiled kernels and more tests, at some 20 s each.
What changes no result, or only what it costs, is listed with its reason (`explained_mutants`).
Mutants are drawn from a seed, in turns from every group of files. `--keep` holds a line for each;
started again, the program goes on behind them.
"""

from __future__ import annotations

import argparse
import ast
import csv
import importlib
import json
import os
import signal
import sys
import tempfile
import time
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path
from typing import Any, NamedTuple

from hypothesis import HealthCheck, Phase, settings

from tests.property import compiled_mutants, interpreter_mode
from tests.property.compiled_mutants import BROKEN, ENDLESS, SEEN, UNSEEN
from tests.property.engine_mutants import ENGINE, GROUPS, ROOT, Mutant, applied, drawn
from tests.property.explained_mutants import explained
from tests.property.forked_tests import (
    Collected,
    Done,
    TookTooLong,
    Work,
    collected,
    forks,
    reached,
)

TESTS = (
    *("tests/unit/engine", "tests/unit/problems", "tests/oracle"),
    *("tests/physics/test_impulse_is_force_times_step.py", "tests/property/test_momentum.py"),
    *("tests/property/test_energy.py", "tests/property/test_symmetries.py"),
    *("tests/physics/test_impacts_in_order.py", "tests/physics/test_pairwise_impacts.py"),
)
# [s] of a processor, and of a clock on a busy machine: of a test that finds which lines it reaches,
# of a file of such tests in these, and of the tests of a mutant, which may never end.
ONE, FILE, ALL = (1.5, 20.0), 10.0, (8.0, 120.0)
BUDGET = 6.0  # [s] of tests by the first of these clocks
PROFILE: dict[str, Any] = {  # of tests that draw; nothing is drawn otherwise in another run
    "max_examples": 20,
    "database": None,
    "derandomize": True,
    "deadline": None,
    "phases": [Phase.explicit, Phase.generate],
    "suppress_health_check": list(HealthCheck),
}
UNREACHED, COMPILED = "no test reaches it", "compiled"
FIELDS = ("file", "line", "column", "kind", "old", "new", "result", "by", "why", "seconds")

Reach = dict[str, dict[int, list[tuple[float, str]]]]  # tests by file and line, with their seconds


class Row(NamedTuple):
    """What became of a mutant."""

    result: str
    by: str = ""
    why: str = ""
    seconds: float = 0.0


def reach_of(tests: Collected, jobs: int, keep: Path | None) -> Reach:
    """Return which tests reach which lines of the engine; from a file, where that is there."""
    whole = keep.with_suffix(".reach") if keep is not None else None
    if whole is not None and whole.exists():
        rows = [json.loads(text) for text in whole.read_text().splitlines()]
    else:
        rows = []
        for row in reached(tests, jobs, ROOT / ENGINE, ONE, FILE):
            rows.append(row)
            if len(rows) % 500 == 0:
                print(f"{len(rows)} tests pass interpreted", flush=True)
        if whole is not None:
            whole.write_text("".join(json.dumps(row) + "\n" for row in rows))
    print(f"{len(rows)} of {len(tests.items)} tests pass interpreted", flush=True)
    found: Reach = {}
    for name, seconds, lines in rows:
        for file, line in lines:
            found.setdefault(file, {}).setdefault(line, []).append((seconds, name))
    return found


def quickest(mutant: Mutant, reach: Reach) -> list[str]:
    """Return tests that reach a mutant's line, or its function, the quickest first, to a budget."""
    lines = reach.get(mutant.file, {})
    text = (ROOT / ENGINE / mutant.file).read_text()
    around = [
        min([node.lineno, *(mark.lineno for mark in node.decorator_list)])
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.FunctionDef)
        and node.lineno <= mutant.line <= (node.end_lineno or 0)
    ]
    names: list[str] = []
    left = BUDGET
    for line in (mutant.line, max(around)):
        for seconds, name in sorted(lines.get(line, [])):
            left -= seconds
            if left < 0.0 and names:
                return names
            if name not in names:
                names.append(name)
    return names


def work_of(tests: Collected, mutant: Mutant, names: list[str]) -> Work:
    """Return what a fork does: break a line, and run tests until one fails."""

    def work(said: Path) -> None:
        path = ROOT / ENGINE / mutant.file
        module = (ENGINE / mutant.file).with_suffix("").as_posix().replace("/", ".")
        importlib.import_module(module)  # some are not loaded before a test asks for them
        if not interpreter_mode.broken(path, applied(path.read_text(), mutant)):
            said.write_text(json.dumps(Row(BROKEN)))
            return
        outcomes = tests.outcomes(names, ALL)
        for name, one in zip(names, outcomes, strict=True):
            if one.failed:
                result = ENDLESS if one.why.endswith(TookTooLong.__name__) else SEEN
                said.write_text(json.dumps(Row(result, name, one.why)))
                return
        said.write_text(json.dumps(Row(UNSEEN)))

    return work


def failing_on_what_is_whole(tests: Collected, names: set[str], jobs: int) -> int:
    """Run tests that saw a mutant without one, each in a fork; returns how many fail."""

    def alone(name: str) -> Work:
        def work(said: Path) -> None:
            (one,) = tests.outcomes([name], ALL)
            said.write_text(one.why if one.failed else "passed")

        return work

    count = 0
    for done in forks(map(alone, sorted(names)), jobs, ALL):
        if done.said != "passed":
            count += 1
            print(f"fails on what is whole: {sorted(names)[done.number]}: {done.said}")
    return count


def ended(done: Done) -> Row:
    """Return what a fork found; one that is killed by its limit never ends, or crashed."""
    if done.said:
        return Row(*json.loads(done.said))._replace(seconds=done.seconds)
    late = done.status in (-signal.SIGKILL, -signal.SIGXCPU)
    result = ENDLESS if late else SEEN if done.status < 0 else BROKEN
    return Row(result, why=f"status {done.status}", seconds=done.seconds)


def interpreted(asked: Any, chosen: list[Mutant]) -> Iterator[tuple[Mutant, Row]]:
    """Try mutants on interpreted kernels; yields each as it ends."""
    found: list[tuple[Mutant, Row]] = []

    def task(tests: Collected) -> int:
        reach = reach_of(tests, asked.jobs, asked.keep)
        begin = time.monotonic()
        sure = {mutant: quickest(mutant, reach) for mutant in chosen}
        tried = [mutant for mutant in chosen if sure[mutant]]
        for mutant in chosen:
            if not sure[mutant]:
                found.append((mutant, Row(UNREACHED)))
                _append(asked.keep, *found[-1])

        def works() -> Iterator[Work]:
            for mutant in tried:
                if time.monotonic() - begin > asked.seconds:
                    return
                yield work_of(tests, mutant, sure[mutant])

        for done in forks(works(), asked.jobs, ALL):
            found.append((tried[done.number], ended(done)))
            _append(asked.keep, *found[-1])
        return failing_on_what_is_whole(tests, {row.by for _, row in found if row.by}, asked.jobs)

    settings.register_profile("mutants", **PROFILE)
    settings.load_profile("mutants")
    interpreter_mode.begin()
    if collected(list(asked.tests or TESTS), task):
        raise SystemExit("tests could not be collected, or fail on what is whole")
    yield from found


def compiled(asked: Any, chosen: list[Mutant]) -> Iterator[tuple[Mutant, Row]]:
    """Try mutants on compiled kernels; yields each as it ends."""
    os.environ["NUMBA_OPT"] = "0"
    with tempfile.TemporaryDirectory() as folder:
        place, kernels = compiled_mutants.copied(Path(folder)), Path(folder) / "kernels"
        tests = {m: asked.tests or compiled_mutants.tests_of(m.file) for m in chosen}
        # Parts of kernels are kept here, so that a mutant compiles what differs; nothing fails yet.
        said = Path(folder) / "said"
        whole = sorted({test for names in tests.values() for test in names})
        limit = compiled_mutants.FIRST
        if compiled_mutants.forked(place, kernels, whole, said, limit) != UNSEEN:
            raise SystemExit(f"a test fails on what is whole: {said.read_text()[-2000:]}")
        begin = time.monotonic()
        for mutant, names in tests.items():
            if time.monotonic() - begin > asked.seconds:
                return
            started = time.monotonic()
            result, by = compiled_mutants.tried(mutant, place, kernels, names)
            row = Row(result, by, COMPILED, time.monotonic() - started)
            _append(asked.keep, mutant, row)
            yield mutant, row


def kept(path: Path | None) -> dict[Mutant, Row]:
    """Return what a file of results says of each mutant last."""
    if path is None or not path.exists():
        return {}
    with path.open(newline="") as file:
        rows = [[row[name] for name in FIELDS] for row in csv.DictReader(file)]
    return {
        Mutant(file, int(line), int(column), *change): Row(result, by, why, float(seconds))
        for file, line, column, *change, result, by, why, seconds in rows
    }


def outcome(mutant: Mutant, row: Row) -> str:
    """Return the column of a mutant in the table of all."""
    if row.result in (SEEN, ENDLESS):
        return "compiled only" if row.why == COMPILED else "seen"
    if row.result == BROKEN:
        return BROKEN
    return "explained" if explained(mutant) else "open"


def report(chosen: list[Mutant], results: dict[Mutant, Row]) -> None:
    """Print what is not seen, with its reason where it has one, and a table of the groups."""
    found = {mutant: outcome(mutant, results[mutant]) for mutant in chosen if mutant in results}
    for mutant, result in found.items():
        if result not in ("seen", "compiled only"):
            print(f"{result}: {mutant.file}:{mutant.line}:{mutant.column + 1}: "
                  f"{mutant.kind}: {mutant.old} -> {mutant.new}: "
                  f"{explained(mutant) or results[mutant].result}")  # fmt: skip
    columns = ("tried", "seen", "compiled only", "explained", "open")
    print(f"{'':9}" + "".join(f"{name:>15}" for name in columns))
    for group, patterns in (*GROUPS.items(), ("all", ("*",))):
        own = [r for m, r in found.items() if any(fnmatch(m.file, p) for p in patterns)]
        counts = [len(own), *(own.count(name) for name in columns[1:])]
        print(f"{group:9}" + "".join(f"{count:15}" for count in counts))
    seen = sum(result in ("seen", "compiled only") for result in found.values())
    print(f"{seen} of {len(found)} mutants are seen")


def main() -> int:
    """Break what is asked for, and say what the tests see; exits 1 where tests could not run."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+", default=[], metavar="FILE", help="patterns of files")
    parser.add_argument("--groups", nargs="+", choices=GROUPS, help="of those drawn, these alone")
    parser.add_argument("--tests", nargs="+", metavar="TEST", help="in place of those of the file")
    parser.add_argument("--keep", type=Path, help="file of results, one line each")
    parser.add_argument("--jobs", type=int, default=1, help="mutants at a time")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="no more after these")
    parser.add_argument("--again", action="store_true", help="what was not seen, by new tests")
    parser.add_argument("--compiled", action="store_true", help="what is not seen, compiled")
    asked = parser.parse_args()
    chosen = drawn(asked.count, asked.seed, asked.only)
    if asked.groups:
        patterns = [pattern for name in asked.groups for pattern in GROUPS[name]]
        chosen = [m for m in chosen if any(fnmatch(m.file, pattern) for pattern in patterns)]
    results = kept(asked.keep)
    unseen = (UNSEEN, UNREACHED)
    if asked.compiled:
        due = [m for m in chosen if results.get(m, Row(UNSEEN)).result in unseen
               and results.get(m, Row("")).why != COMPILED and not explained(m)]  # fmt: skip
    else:
        retried = (BROKEN, *(unseen if asked.again else ()))
        due = [m for m in chosen if results.get(m, Row(BROKEN)).result in retried]
    if due:
        results |= dict((compiled if asked.compiled else interpreted)(asked, due))
    report(chosen, results)
    return int(any(row.result == BROKEN for row in results.values()))


def _append(path: Path | None, mutant: Mutant, row: Row) -> None:
    if path is None:
        return
    new = not path.exists()
    with path.open("a", newline="") as file:
        writer = csv.writer(file)
        if new:
            writer.writerow(FIELDS)
        writer.writerow((*mutant, *row[:-1], f"{row.seconds:.1f}"))


if __name__ == "__main__":
    sys.exit(main())
