"""A run is killed before every call of the system that it makes: what is left, and what follows.

    python -m tests.property.killed_calls                    before every call
    python -m tests.property.killed_calls --every 7          before every seventh

The library of `failing_calls` kills the process (SIGKILL) before the n-th call that touches the
folder of runs, for n = 0, 1, ... until a run makes fewer. What is left is listed, shown, verified
and recovered; then it is resumed (even n), or a new run begins (odd n).
"""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from tests.property.failing_calls import KILLED, LIBRARY, Runs, preloaded
from tests.property.killed_runs import (
    READ,
    finished,
    half_written,
    wrong_verb,
    wrong_when_recovered,
)
from tests.runner.run_contents import contents


def wrong(runs: Runs, number: int) -> Iterator[str]:
    """Yield `killed` or `whole`, then each thing that is wrong after the kill."""
    where, found = runs.failing(number, KILLED)
    try:
        if found.code != -signal.SIGKILL:
            yield "whole"
            if found.code:
                yield f"exit code {found.code}: {found.said}"
            return
        yield "killed"
        yield from _wrong_when_read(runs, where)
        yield from _wrong_after(runs, where, resume=number % 2 == 0)
    finally:
        shutil.rmtree(where, ignore_errors=True)


def _wrong_when_read(runs: Runs, where: Path) -> Iterator[str]:
    from lavendersim.runner import list_runs, open_run
    from lavendersim.runner.verification import problems_of

    if not open_run(None, where).finished:
        yield "latest is not finished"
    there = list_runs(where)
    for one in finished(where):
        if problems := [*problems_of(one)]:
            yield f"says that it is done, and is not: {problems}"
    yield from wrong_verb({0}, "ls", "--runs", where)
    yield from wrong_verb({0}, "show", "--runs", where)
    yield from wrong_verb({0}, "verify", there[0].path)
    if len(there) == 1:  # killed before there was anything to list
        return
    left = there[-1]
    yield from wrong_verb({0} if left.finished else {2, 3}, "show", left.path)
    yield from wrong_verb({0} if left.finished else {0, 2, 3}, "verify", left.path)
    copy = runs.top / "copy"
    yield from wrong_when_recovered(left, copy)
    shutil.rmtree(copy)


def _wrong_after(runs: Runs, where: Path, resume: bool) -> Iterator[str]:
    from lavendersim.runner import list_runs, run

    unfinished = not list_runs(where)[-1].finished
    last = run(runs.config, where, resume=resume and unfinished).run
    if contents(last) != runs.whole:
        yield "the run after it holds something else"
    if contents(list_runs(where)[0]) != runs.whole:
        yield "the run before it has changed"
    if left := half_written(where):
        yield f"left: {left}"
    yield from wrong_verb({0}, "verify", last.path)


def main() -> None:
    """Kill before every call, or every n-th; exits 1 where something is wrong."""
    parser = argparse.ArgumentParser(description="Kills a run before every call of the system.")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="every N-th call")
    asked = parser.parse_args()
    if LIBRARY not in os.environ:
        with tempfile.TemporaryDirectory() as folder:
            module = "tests.property.killed_calls"
            done = preloaded(Path(folder), "--every", str(asked.every), module=module)
            print(done.stdout, end="")
            sys.exit(done.returncode)
    ends: Counter[str] = Counter()
    bad = 0
    for name in ("shared", "partly"):
        with tempfile.TemporaryDirectory() as folder:
            runs = Runs(Path(folder), READ[name])
            number, end = 0, "killed"
            while end == "killed":
                end, *said = wrong(runs, number)
                ends[end] += 1
                for one in said:
                    print(f"{name}, before call {number}: {one}", flush=True)
                bad += bool(said)
                number += asked.every
    print(f"{ends['killed']} killed before a call, {ends['whole']} made fewer calls")
    print(f"{bad} with something wrong")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
