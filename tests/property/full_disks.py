"""Runs whose disk is full: what they say, and what the command that goes on makes of them.

    unshare -rm python -m tests.property.full_disks --count 24 --seed 1

Each run has a disk of its own, in memory (tmpfs), of a size drawn up to a little more than all of
it takes; then the disk is made larger, and the command that was printed is run. To mount one needs
rights that `unshare -rm` gives. Prints what is wrong, a line each. The suite fills three.
"""

from __future__ import annotations

import argparse
import random
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from lavendersim.runner import list_runs, run
from tests.property.killed_runs import MANY, half_written
from tests.runner.run_contents import contents

RESTITUTIONS = [[round(0.1 + i / 100, 2) for i in range(cells)] for cells in (60, 14)]
PAGE = 4096  # [byte] that a file of a tmpfs takes at least
GO_ON = "go on with: "
LAVENDER = """
import sys
import lavendersim.runner.executor as executor
from lavender_cli.main import main
executor.WORTH_PROCESSES = -1.0
sys.argv[0] = "lavender"
main()
"""


class Case(NamedTuple):
    """A config, its exit code, what its run holds, and how much room [byte] that takes."""

    config: Path
    code: int
    whole: dict[str, Any]
    size: int


def prepared(folder: Path) -> Case:
    """Write the config into a folder and run it there; kernels are on disk afterwards."""
    config = folder / "many.yaml"
    config.write_text(MANY.replace(*map(str, RESTITUTIONS)))
    finished = run(config, folder / "whole")
    found = finished.run
    pages = sum(-(-path.stat().st_size // PAGE) for path in found.path.rglob("*"))
    return Case(config, 0 if finished.good else 1, contents(found), pages * PAGE)


def mounted(command: str, *words: object) -> None:
    """Call mount or umount."""
    subprocess.run([command, *map(str, words)], check=True)


def lavender(words: list[str]) -> subprocess.CompletedProcess[str]:
    """Run the command line, with processes however short the cells are."""
    return subprocess.run(
        [sys.executable, "-c", LAVENDER, *words], capture_output=True, text=True, check=False
    )


def wrong(case: Case, disk: Path, size: int, jobs: int) -> Iterator[str]:
    """Yield `full` or `whole`, then each thing that is wrong."""
    mounted("mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", disk)
    try:
        runs = disk / "runs"
        given = ["--runs", str(runs), "--jobs", str(jobs), "--yes"]  # the room is said to be short
        done = lavender(["run", str(case.config), *given])
        yield "whole" if done.returncode == case.code else "full"
        if done.returncode != case.code:
            if done.returncode != 6 or "Traceback" in done.stderr:
                yield f"exit code {done.returncode}: {done.stderr[-400:]}"
            lines = [line for line in done.stderr.splitlines() if line.startswith(GO_ON)]
            if not lines:
                yield f"does not say how to go on: {done.stderr[-400:]}"
                return
            mounted("mount", "-o", "remount,size=1G", disk)
            again = lavender(shlex.split(lines[0].removeprefix(GO_ON))[1:])
            if again.returncode != case.code:
                yield f"going on, exit code {again.returncode}: {again.stderr[-400:]}"
                return
        last = list_runs(runs)[-1]
        if not last.finished or contents(last) != case.whole:
            yield "the run holds something else"
        if hidden := half_written(runs):
            yield f"left: {hidden}"
    finally:
        mounted("umount", disk)


def main() -> None:
    """Fill as many disks as are asked for; exits 1 where something is wrong."""
    parser = argparse.ArgumentParser(description="Runs of which the disk is full.")
    parser.add_argument("--count", type=int, default=24)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    draw = random.Random(asked.seed)
    ends: list[str] = []
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        top = Path(folder)
        case = prepared(top)
        (top / "disk").mkdir()
        for number in range(asked.count):
            size, jobs = draw.randrange(3 * PAGE, int(1.1 * case.size)), 1 + number % 2
            end, *said = wrong(case, top / "disk", size, jobs)
            ends.append(end)
            for one in said:
                print(f"{number}: {size} bytes, {jobs} jobs: {one}", flush=True)
            bad += bool(said)
    print(f"{ends.count('full')} disks were full, {ends.count('whole')} were large enough")
    print(f"{bad} with something wrong")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
