"""Shards made into a run: their logs in one directory, judged as if one process had run all cells.

    DIR/shards/*/cells/*.mcap -> every cell once, every byte read -> the directory of a run

Equal cells give equal bytes, so where several workers ran one, their logs have to be equal; that
they are is checked.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from lavendersim.config_options import ConfigOptions
from lavendersim.errors import TraceError, UsageError
from lavendersim.experiment import Experiment, load_experiment_text

from .ended_logs import ended_in, whole_log
from .experiment_run import Finished, complete, make_directory
from .leases import Leases
from .progress import Progress
from .run_directory import CONFIG, RUNS, check_latest, point_latest
from .run_lock import run_lock
from .shards import link, read_identity, refuse_others, shards_in

if TYPE_CHECKING:
    from .cell_outcome import EndedCell


class Missing(NamedTuple):
    """What a merge waits for."""

    cells: list[str]  # labels of cells that no shard has
    running: int  # of these, how many a worker that lives has
    damaged: list[str]  # a sentence of each log that is not what was written
    total: int  # different cells


def merge(
    into: Path,
    root: Path | str = RUNS,
    progress: Progress = Progress(),  # noqa: B008 - immutable
) -> Finished | Missing:
    """Make a run of the shards in a folder, in a new directory of `root`; they stay as they are.

    UsageError where there are none, or some are of another config or engine. TraceError where two
    of them have different bytes for one cell.
    """
    from lavendersim.measures.own_file import may_measure

    from .cell_jobs import different, prepare
    from .shards import identity_of

    shards = shards_in(into)
    if not shards:
        raise UsageError(f"{into}: no shards: `lavender run CONFIG --into {into}` makes some")
    experiment = experiment_of(shards[0])
    prepared = prepare(experiment)
    refuse_others(into, identity_of(prepared))
    by_log = {path.name: job for path, job in different(prepared.jobs(into)).items()}
    found = ended_in(shards, unmeasured=may_measure(experiment.measures.values()))
    done, damaged = _whole(found, [*by_log])
    if left := [log for log in by_log if log not in done]:
        labels = [by_log[log].cells[0].label or experiment.name for log in left]
        running = Leases(into).run_by_others(left)
        return Missing(labels, len(running), damaged, len(by_log))
    root = Path(root)
    check_latest(root)
    directory = make_directory(experiment, root)
    with run_lock(directory):
        cells = directory / "cells"
        cells.mkdir()
        for log, (shard, _) in done.items():
            link(shard / "cells" / log, cells / log)
        ended = {log: one for log, (_, one) in done.items()}
        finished = complete(prepared, directory, ended, jobs=1, progress=progress)
    point_latest(directory, root)
    return finished


def experiment_of(shard: Path) -> Experiment:
    """Return the experiment of a shard, as it was run."""
    known = read_identity(shard)
    try:
        text = (shard / CONFIG).read_bytes()
        options = ConfigOptions.of_row(known)._asdict()
        experiment = load_experiment_text(text, str(shard / CONFIG), **options)
        return replace(experiment, name=known["experiment"])
    except (KeyError, TypeError) as error:
        raise TraceError(f"{shard}: damaged: {error} is missing") from None


def _whole(
    ended: Mapping[str, Sequence[tuple[Path, EndedCell]]], logs: Sequence[str]
) -> tuple[dict[str, tuple[Path, EndedCell]], list[str]]:
    """Return one whole log of each cell, and a sentence of every log that is damaged."""
    whole: dict[str, tuple[Path, EndedCell]] = {}
    damaged: list[str] = []
    for log in logs:
        found = ended.get(log, ())
        digests = {one.outcome.log for _, one in found}
        if len(digests) > 1:
            where = ", ".join(str(shard / "cells" / log) for shard, _ in found)
            raise TraceError(f"{where}: one cell, but not the same bytes")
        for shard, one in found:
            try:
                whole_log(shard / "cells" / log, one.outcome)
            except (TraceError, OSError) as error:
                damaged.append(str(error))
                continue
            whole[log] = shard, one
            break
    return whole, damaged
