"""Groups of steps: whole where all their chunks came, lost where one is missing or does not fit."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
import pytest
from logs_of_samples import Logged, logged
from mcap.records import ChunkIndex

from lavendersim.trace.container import FileIndex
from lavendersim.trace.groups import GEOMETRY, STEP, Groups
from lavendersim.trace.layout import CHANNELS

STEPS = 901


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Logged:
    return logged(tmp_path_factory.mktemp("log") / "a.mcap", STEPS)


def begun(log: Logged) -> Groups:
    """Return no group yet, of a log whose summary, attachments and metadata are there."""
    index = log.index
    entries = FileIndex(dict(index.schemas), dict(index.channels))
    entries.attachments, entries.metadata = index.attachments, index.metadata
    return Groups(log.path, entries)


def taken(log: Logged, keep: Callable[[int, ChunkIndex], bool]) -> Groups:
    groups = begun(log)
    for number, (entry, content) in enumerate(log.chunks()):
        if keep(number, entry):
            groups.take(entry, content)
    return groups


def test_a_whole_log_is_groups_that_follow_one_another(log: Logged) -> None:
    groups = taken(log, lambda number, entry: True)
    ends = [(group.first, group.last) for group in groups.whole]
    assert len(ends) > 3
    assert ends[0][0] == 0
    assert ends[-1][1] == STEPS - 1
    assert all(after[0] == before[1] + 1 for before, after in itertools.pairwise(ends))
    times = log.block.step["time_ns"]
    assert [(g.begin, g.end) for g in groups.whole] == [(times[a], times[b]) for a, b in ends]
    assert not groups.unfinished


def test_every_chunk_of_a_group_is_needed(log: Logged) -> None:
    """Each chunk left out by itself: exactly the steps of its times are lost."""
    all_steps = set(range(STEPS))
    times = log.block.step["time_ns"]
    for missing, entry in enumerate(log.index.chunks):
        if entry.message_index_offsets.keys() == GEOMETRY:
            continue
        groups = taken(log, lambda number, _, missing=missing: number != missing)
        kept = {step for g in groups.whole for step in range(g.first, g.last + 1)}
        inside = np.flatnonzero(
            (times >= entry.message_start_time) & (times <= entry.message_end_time)
        )
        assert set(inside.tolist()) <= all_steps - kept
        if STEP not in entry.message_index_offsets:
            assert len(groups.whole) == len(taken(log, lambda n, e: True).whole) - 1


def test_a_loss_spoils_the_group_it_stands_in_alone(log: Logged) -> None:
    whole = taken(log, lambda number, entry: True).whole
    groups = begun(log)
    groups.lose(GEOMETRY)  # a chunk apart
    assert not groups.unfinished
    groups.lose(frozenset({CHANNELS["/tf"]}))
    assert groups.unfinished
    for entry, content in log.chunks():
        groups.take(entry, content)
    assert groups.whole == whole[1:]
    groups.lose(frozenset({STEP}))  # the light chunk ends its group: what follows is another
    assert not groups.unfinished


def test_what_is_whole_is_entered_with_its_counts(log: Logged) -> None:
    groups = taken(log, lambda number, entry: True)
    assert groups._entries.counts == log.index.counts
    assert groups._entries.chunks == log.index.chunks
