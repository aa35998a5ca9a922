"""Records one after the other: stretches tile the file, as mcap's reader finds them."""

from __future__ import annotations

import itertools
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from logs_of_samples import Logged, logged, records
from mcap.opcode import Opcode

from lavendersim.trace.walk import NOTHING, SUMMARY, walk
from lavendersim.trace.whole import BLOCK, MAGIC


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Logged:
    return logged(tmp_path_factory.mktemp("log") / "a.mcap", 300)


def test_a_whole_log_is_walked_without_a_gap(log: Logged) -> None:
    data = log.path.read_bytes()
    found = list(walk(BytesIO(data)))
    assert found[0].start == len(MAGIC)
    assert all(after.start == before.end for before, after in itertools.pairwise(found))
    names = [Opcode(one.opcode).name.title().replace("_", "") for one in found]
    assert names == [type(one).__name__ for one in records(data, magic=True)][: len(found)]
    assert found[-1].opcode == Opcode.DATA_END
    starts = [one.start for one in found if one.opcode == Opcode.CHUNK]
    assert starts == [entry.chunk_start_offset for entry in log.index.chunks]


def test_stretches_tile_a_damaged_log_and_others_stay(log: Logged) -> None:
    data = log.path.read_bytes()
    truth = list(walk(BytesIO(data)))
    random = np.random.default_rng(1)
    for _ in range(60):
        place = int(random.integers(len(MAGIC), truth[-1].start))
        length = int(random.integers(1, 60))
        broken = data[:place] + bytes(length) + data[place + length :]
        found = list(walk(BytesIO(broken)))
        assert all(after.start == before.end for before, after in itertools.pairwise(found))
        hit = {one.start for one in truth if one.start < place + length and one.end > place}
        starts = {(one.start, one.end, one.opcode) for one in found}
        assert {(t.start, t.end, t.opcode) for t in truth if t.start not in hit} <= starts


@pytest.mark.parametrize("foreign", [b"\0", b"\x01" * 9, b"\xff" * 5000, b"\xff" * (BLOCK - 4)])
def test_what_was_put_between_two_records_is_one_stretch(log: Logged, foreign: bytes) -> None:
    """Also where the next record lies across the end of the bytes that are read at once."""
    data = log.path.read_bytes()
    at = log.index.chunks[1].chunk_start_offset
    found = list(walk(BytesIO(data[:at] + foreign + data[at:])))
    gaps = [(one.start, one.end) for one in found if one.opcode == NOTHING]
    assert gaps == [(at, at + len(foreign))]


def test_another_magic_is_a_stretch_of_its_own(log: Logged) -> None:
    data = log.path.read_bytes()
    first, second, *_ = walk(BytesIO(b"\0" * len(MAGIC) + data[len(MAGIC) :]))
    assert (first.start, first.end, first.opcode) == (0, len(MAGIC), NOTHING)
    assert second.opcode == Opcode.HEADER


def test_the_walk_ends_at_the_summary_and_at_the_end_of_a_cut_file(log: Logged) -> None:
    data = log.path.read_bytes()
    end = next(one for one in walk(BytesIO(data)) if one.opcode == Opcode.DATA_END)
    without = data[: end.start] + data[end.end :]
    *_, last = walk(BytesIO(without))
    assert last.opcode in SUMMARY
    *_, cut = walk(BytesIO(data[: end.start + 5]))
    assert (cut.opcode, cut.end) == (NOTHING, end.start + 5)


def test_a_length_that_damage_made_is_not_believed(log: Logged, tmp_path: Path) -> None:
    """A chunk's length stands there twice, and so does that of a message index."""
    data = bytearray(log.path.read_bytes())
    entry = log.index.chunks[2]
    data[entry.chunk_start_offset + 2] ^= 1
    found = [one for one in walk(BytesIO(bytes(data))) if one.start == entry.chunk_start_offset]
    assert [one.opcode for one in found] == [NOTHING]
