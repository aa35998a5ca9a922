"""A sweep run by workers that share a folder, or each alone: what one of them did is a shard.

    DIR/shards/3-of-8/              what one of eight workers was given
    DIR/shards/HOST-PID/            what a worker ran that joined: cells that nobody had
        shard.json, config.yaml     of which experiment, with which engine
        cells/LOG.mcap, ended.jsonl as in the directory of a run
    DIR/leases/LOG                  which worker runs a cell: see `leases`

`merge` makes a run of them.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import socket
from collections import deque
from collections.abc import Mapping
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from lavendersim.durable_files import flush_tree, write_whole
from lavendersim.errors import TraceError, UsageError
from lavendersim.experiment import Experiment

from .ended_logs import EndedLogs
from .interruption import Interrupted, handled
from .leases import SHARDS, Leases, alive
from .leftovers import UNFINISHED
from .progress import Progress
from .run_directory import CONFIG
from .run_index import drop_cut_line

if TYPE_CHECKING:
    from .cell import CellJob
    from .cell_jobs import Prepared

SHARD: Final = "shard.json"
# Cells that a worker takes at once are to keep it busy for so long [s]: fewer, and processes are
# started anew too often; more, and others wait at the end of the sweep.
BATCH: Final = 20.0


class ShardRun(NamedTuple):
    """What a worker did, and what is left of its cells."""

    shard: Path
    ran: int
    measured: int  # of cells whose logs were closed before their worker was killed
    lost: list[str]  # a sentence of every cell whose process died
    ended: int  # of `cells`, here or by other workers
    cells: int  # different ones that it was given: all, or those of its part


def part_of(text: str) -> tuple[int, int]:
    """Return part and parts of `3/8`. UsageError where it is no such part."""
    found = re.fullmatch(r"(\d{1,6})/(\d{1,6})", text)
    part, parts = (int(found[1]), int(found[2])) if found else (0, 0)
    if not 1 <= part <= parts:
        raise UsageError(f"--shard {text}: expected K/N with K from 1 to N, such as 3/8")
    return part, parts


def run_shard(
    experiment: Experiment,
    into: Path,
    part: tuple[int, int] | None = None,
    jobs: int = 1,
    progress: Progress = Progress(),  # noqa: B008 - immutable
) -> ShardRun:
    """Run cells of an experiment into a folder that other workers may share; nothing is judged.

    part: number and count of the part that is run, (3, 8); None: whatever nobody else runs.
    jobs: processes. Cells that ended before, here or by another worker, are not run again.
    UsageError where the folder has cells of another config or engine.
    """
    from .cell_jobs import different, prepare

    prepared = prepare(experiment)
    identity = identity_of(prepared)
    refuse_others(into, identity)
    shard = _directory(into, part)
    (shard / "cells").mkdir(exist_ok=True)
    with alive(shard):
        for left in shard.rglob(UNFINISHED):
            left.unlink()
        drop_cut_line(shard)
        write_whole(shard / CONFIG, experiment.text, flush=False)
        write_whole(shard / SHARD, json.dumps(identity, indent=1) + "\n")
        by_log = {path.name: job for path, job in different(prepared.jobs(shard)).items()}
        if part is not None:
            number, parts = part
            by_log = dict([*by_log.items()][number - 1 :: parts])
        worker = _Worker(into, shard, by_log, jobs, progress)
        try:
            with handled():
                worker.run(whole=part is not None)
        except Interrupted as end:
            whole = f"{worker.ran + worker.measured} cells of it are whole"
            raise Interrupted(f"{experiment.name}: {end}: {whole}, {shard}") from None
        finally:
            flush_tree(shard)
    done = EndedLogs(into).read()
    return ShardRun(
        shard, worker.ran, worker.measured, worker.lost, len(done & by_log.keys()), len(by_log)
    )


class _Worker:
    """Takes cells that nobody has, and runs them, until none is left."""

    def __init__(
        self,
        into: Path,
        shard: Path,
        by_log: Mapping[str, CellJob],
        jobs: int,
        progress: Progress,
    ) -> None:
        self._leases, self._shard = Leases(into), shard.name
        self._ended = EndedLogs(into)
        self._by_log, self._jobs, self._progress = by_log, jobs, progress
        self.ran = self.measured = 0
        self.lost: list[str] = []

    def run(self, whole: bool) -> None:
        """Run what is left; whole: take all of it at once, nobody else is to run it."""
        from .executor import outcomes_of

        most = len(self._by_log) if whole else self._jobs
        waiting = deque(self._by_log)
        while batch := self._take(waiting, most):
            begin = perf_counter()
            tasks = [self._by_log[log] for log in batch if not self._measure_closed(log)]
            for job, (outcome, _) in outcomes_of(tasks, self._jobs, self._progress):
                self.ran += 1
                if outcome.log is None:
                    self.lost.append(f"cell {job.cells[0].label or job.cell}: {outcome.status}")
                self._progress.cell_done(self.ran + self.measured, len(self._by_log))
            took = perf_counter() - begin
            most = max(self._jobs, min(2 * most, int(most * BATCH / max(took, 1e-3))))

    def _measure_closed(self, log: str) -> bool:
        """Measure a cell whose log was closed by a worker that was killed; false where none was."""
        from .cell import measured_later

        if (closed := self._ended.closed(log)) is None:
            return False
        path, outcome = closed
        job = self._by_log[log]
        if path != job.path:
            job.path.unlink(missing_ok=True)
            link(path, job.path)
        measured_later(job, outcome)
        self.measured += 1
        self._progress.cell_done(self.ran + self.measured, len(self._by_log))
        return True

    def _take(self, waiting: deque[str], most: int) -> list[str]:
        """Return the logs of at most so many cells that this worker runs now.

        waiting: logs that were not looked at yet; none is looked at twice, for who has it lives.
        """
        dead: set[str] = set()
        taken: list[str] = []
        while waiting and not taken:
            done = self._ended.read()
            while waiting and len(taken) < most:
                log = waiting.popleft()
                if log not in done and self._leases.take(log, self._shard, dead):
                    taken.append(log)
            # A worker may have ended a cell, and itself, after it was looked at.
            done = self._ended.read()
            taken = [log for log in taken if log not in done]
        return taken


def identity_of(prepared: Prepared) -> dict[str, Any]:
    """Return what all shards of one sweep have in common, beside the config as written."""
    from .environment import versions

    one = prepared.experiment
    engine_and_cells = "\n".join(prepared.logs)
    return {
        "experiment": one.name,
        "config": hashlib.sha256(one.text.encode("utf-8", "surrogatepass")).hexdigest(),
        **one.options.row,
        "versions": versions(),
        "logs": hashlib.sha256(engine_and_cells.encode()).hexdigest(),
    }


DIFFERS: Final = {
    "experiment": "another experiment",
    "config": "another config",
    "versions": "other versions",
    "logs": "another engine",
}


def refuse_others(into: Path, identity: Mapping[str, Any]) -> None:
    """Raise UsageError where a shard of a folder is of another config or engine."""
    for path in shards_in(into):
        found = read_identity(path)
        differing = [name for name in identity if found.get(name) != identity[name]]
        if differing:
            what = DIFFERS.get(differing[0], "other options")
            raise UsageError(f"{path}: a shard of {what}; every sweep needs a folder of its own")


def read_identity(shard: Path) -> dict[str, Any]:
    """Return what a shard says it is of. TraceError where that is damaged."""
    try:
        found = json.loads((shard / SHARD).read_bytes())
        if not isinstance(found, dict):
            raise ValueError("no table")
    except (ValueError, RecursionError) as error:
        raise TraceError(f"{shard / SHARD}: damaged: {error}") from None
    return found


def shards_in(into: Path) -> list[Path]:
    """Return the shards of a folder, by name; one that is just being made is none yet."""
    return sorted(path.parent for path in into.glob(f"{SHARDS}/*/{SHARD}"))


def _directory(into: Path, part: tuple[int, int] | None) -> Path:
    """Return the directory of a shard; a worker that joins has one that is new."""
    shards = into / SHARDS
    shards.mkdir(parents=True, exist_ok=True)
    if part is not None:
        path = shards / f"{part[0]}-of-{part[1]}"
        path.mkdir(exist_ok=True)
        return path
    host = re.sub(r"[^\w-]", "_", socket.gethostname())[:60]
    for attempt in range(1000):
        path = shards / f"{host}-{os.getpid()}{f'.{attempt}' if attempt else ''}"
        try:
            path.mkdir()
        except FileExistsError:
            continue
        return path
    raise UsageError(f"{shards}: a thousand workers of one name")


def link(log: Path, path: Path) -> None:
    """Give a log another name, which takes no room; where a file system has no links, copy it."""
    try:
        os.link(log, path)
    except OSError:
        shutil.copyfile(log, path)
