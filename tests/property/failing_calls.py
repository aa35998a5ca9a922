"""Every call of the system that a run makes fails once: what is said, and what is left.

    python -m tests.property.failing_calls                   every call, by three errors
    python -m tests.property.failing_calls --every 7         every seventh

A library before the C library (`failing_calls.c`, made with the system's compiler) lets the n-th of
open, write, fsync, rename, mkdir, link, symlink and unlink that touches the folder of runs fail,
for n = 0, 1, ... until a run makes fewer. As SQLite tests its files. The process that asks is
forked for each run, so that nothing is imported or compiled again.
"""

from __future__ import annotations

import argparse
import ctypes
import errno
import os
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from tests.property.killed_runs import SHARED, half_written

SOURCE = Path(__file__).with_suffix(".c")
LIBRARY = "LAVENDER_TEST_FAILING_CALLS"  # where the library is, in the process that has it before
ERRORS = (errno.ENOSPC, errno.EIO, errno.EACCES)
CODES = {errno.ENOSPC: 6, errno.EIO: 6, errno.EACCES: 2}  # docs/commands.md, exit codes
KILLED = -1  # in place of an error
LATE = ("unlink",)  # of what is left over: a run may go on without


class Found(NamedTuple):
    """What became of a run one call of which failed."""

    call: str  # empty: it made fewer
    code: int
    said: str


def preloaded(
    folder: Path, *arguments: str, module: str = "tests.property.failing_calls"
) -> subprocess.CompletedProcess[str]:
    """Run a module in a process that has the library before the C library."""
    library = folder / "failing_calls.so"
    compiler = shutil.which("cc") or shutil.which("gcc") or "cc"
    make = [compiler, "-shared", "-fPIC", "-O1", "-o", library, SOURCE, "-ldl"]
    subprocess.run([str(one) for one in make], check=True)
    return subprocess.run(
        [sys.executable, "-m", module, *arguments],
        env=os.environ | {"LD_PRELOAD": str(library), LIBRARY: str(library), "NO_COLOR": "1"},
        cwd=Path(__file__).parents[2],
        stdout=subprocess.PIPE,
        text=True,
        check=False,
    )


class Runs:
    """A folder with a finished run, in which runs fail."""

    def __init__(self, top: Path, text: str = SHARED) -> None:
        from lavendersim.runner import run
        from tests.runner.run_contents import contents

        self.library = ctypes.CDLL(os.environ[LIBRARY])
        self.library.failing_calls_which.restype = ctypes.c_char_p
        self.top, self.config = top, top / "drops.yaml"
        self.config.write_text(text)
        self.whole = contents(run(self.config, top / "whole").run)

    def failing(self, number: int, error: int) -> tuple[Path, Found]:
        """Let the command run, in a new folder with a run in it, whose n-th call fails.

        error: `KILLED` kills it before the call.
        """
        from lavendersim.runner import run

        runs = self.top / f"{number}-{error}"
        run(self.config, runs)
        said, failed = self.top / "stderr", self.top / "call"
        failed.write_text("")
        process = os.fork()
        if process == 0:
            self._run(runs, (number, error), said, failed)
        _, status = os.waitpid(process, 0)
        return runs, Found(
            failed.read_text(), os.waitstatus_to_exitcode(status), said.read_text(errors="replace")
        )

    def _run(self, runs: Path, fails: tuple[int, int], said: Path, failed: Path) -> None:
        from lavender_cli.main import main

        code = 99
        try:
            with said.open("w") as err, Path(os.devnull).open("w") as out:
                os.dup2(err.fileno(), 2)
                os.dup2(out.fileno(), 1)
                sys.argv = ["lavender", "run", str(self.config), "--runs", str(runs)]
                self.library.failing_calls_arm(str(runs).encode(), *fails)
                try:
                    main()
                    code = 0
                except SystemExit as end:
                    code = int(end.code or 0)
                sys.stderr.flush()
                which = self.library.failing_calls_which().decode()
                self.library.failing_calls_arm(b"", -1, 0)
                failed.write_text(which)
        finally:
            os._exit(code)


def wrong(runs: Runs, number: int, error: int) -> Iterator[tuple[Found, str]]:
    """Yield what became of a run whose n-th call failed, and each thing that is wrong with it."""
    from lavendersim.runner import list_runs, open_run, run
    from lavendersim.runner.verification import problems_of
    from tests.runner.run_contents import contents

    where, found = runs.failing(number, error)
    yield found, ""
    try:
        if not found.call:
            return
        if "Traceback" in found.said or found.code in (4, 99) or found.code < 0:
            yield found, f"exit code {found.code}: {found.said[-400:]}"
        elif found.code and found.code != CODES[error]:
            yield found, f"exit code {found.code}, expected {CODES[error]}: {found.said}"
        elif found.code and os.strerror(error).lower() not in found.said.lower():
            yield found, f"does not say why: {found.said}"
        there = list_runs(where)
        for one in there:
            if one.finished and (problems := [*problems_of(one)]):
                yield found, f"says that it is done, and is not: {problems}"
        if contents(there[0]) != runs.whole:
            yield found, "an earlier run has changed"
        if not open_run(None, where).finished:
            yield found, "latest is not finished"
        last = run(runs.config, where, resume=True).run
        if contents(last) != runs.whole:
            yield found, "the run that goes on holds something else"
        if hidden := half_written(where):
            yield found, f"left: {hidden}"
    finally:
        shutil.rmtree(where, ignore_errors=True)


def main() -> None:
    """Let every call fail, or every n-th; exits 1 where something is wrong."""
    parser = argparse.ArgumentParser(description="Lets every call of the system fail once.")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="every N-th call")
    asked = parser.parse_args()
    if LIBRARY not in os.environ:
        with tempfile.TemporaryDirectory() as folder:
            done = preloaded(Path(folder), "--every", str(asked.every))
            print(done.stdout, end="")
            sys.exit(done.returncode)
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(Path(folder))
        failed: Counter[str] = Counter()
        codes: Counter[int] = Counter()
        bad = 0
        for error in ERRORS:
            number, made = 0, True
            while made:
                for found, what in wrong(runs, number, error):
                    made = bool(found.call)
                    if what:
                        print(
                            f"{found.call} {number}, {errno.errorcode[error]}: {what}", flush=True
                        )
                        bad += 1
                    elif made:
                        failed[found.call] += 1
                        codes[found.code] += 1
                number += asked.every
    calls: dict[str, Any] = dict(sorted(failed.items()))
    print(f"{sum(failed.values())} calls failed: {calls}; exit codes {dict(sorted(codes.items()))}")
    print(f"{bad} with something wrong")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
