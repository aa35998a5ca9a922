"""What a log may claim: sizes before memory is taken for them, numbers before they are used.

A log is data of whoever made it. What it claims of itself (a chunk of 100 GB, a timestep of
1e30000000) is compared with what can be before it costs memory or time.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from fractions import Fraction
from functools import lru_cache
from typing import Final

import zstandard
from mcap.records import Chunk, ChunkIndex

from lavendersim.clock import Clock

# Chunks are closed at 16 MiB; one step of many contacts may need more. What contacts and poses are
# compressed to is a third to a hundredth; zstd alone could give 30,000 times as much.
FREE_BYTES: Final = 64 * 1024 * 1024
MOST_GROWTH: Final = 1000
MOST_DIGITS: Final = 1000  # of a timestep; that of 5e-324 s has 326
MOST_BITS: Final = 1 << 16  # of a time's denominator, after many changes of the timestep
MOST_CHANGES: Final = 100_000  # a config has no more values
_RATIO: Final = re.compile(r"[0-9]+(/[0-9]+)?")


def check_chunk(chunk: Chunk) -> None:
    """Raise ValueError where a chunk claims more than its compressed bytes can be of."""
    claimed, stored = chunk.uncompressed_size, zstandard.frame_content_size(chunk.data)
    if claimed != stored:
        raise ValueError(f"a chunk claims {claimed} bytes, its compressed data {stored}")
    check_growth(claimed, len(chunk.data), "a chunk")


def claimed_by(chunk: Chunk) -> int:
    """Return how many bytes the compressed data of a chunk would be; 0 where they do not say."""
    try:
        return max(zstandard.frame_content_size(chunk.data), 0)
    except zstandard.ZstdError:
        return 0


def check_chunks(chunks: Iterable[ChunkIndex], size: int) -> None:
    """Raise ValueError where the chunks of a file of this size [byte] claim more than they hold."""
    check_growth(sum(entry.uncompressed_size for entry in chunks), size, "its chunks")


def check_growth(claimed: int, stored: int, what: str) -> None:
    """Raise ValueError where so many bytes cannot be in those that are stored."""
    if claimed > max(FREE_BYTES, MOST_GROWTH * stored):
        sentence = f"{what} of {stored} bytes would be {claimed}"
        raise ValueError(f"{sentence}, more than {MOST_GROWTH} times as many")


def timestep_of(text: object) -> Fraction:
    """Return the timestep [s] that a log gives, such as `1/480`. ValueError for what is none."""
    if not isinstance(text, str) or len(text) > MOST_DIGITS or not _RATIO.fullmatch(text):
        raise ValueError("a timestep is no ratio of whole numbers")
    numerator, _, denominator = text.partition("/")
    if int(denominator or 1) == 0:
        raise ValueError("a timestep divides by zero")
    timestep = Fraction(int(numerator), int(denominator or 1))
    if not 0.0 < float(timestep) < 1e10:
        raise ValueError("a timestep is no time that a run can have")
    return timestep


def changes_of(given: object) -> list[tuple[int, Fraction]]:
    """Return after how many steps the timestep changes, and to what [s]. ValueError else."""
    if not isinstance(given, list) or len(given) > MOST_CHANGES:
        raise ValueError(f"its timestep changes otherwise than {MOST_CHANGES} times or less")
    changes, last = [], -1
    for change in given:
        if not isinstance(change, list) or len(change) != 2 or type(change[0]) is not int:
            raise ValueError("a change of the timestep is no step and timestep")
        if not last < change[0] < 2**63:
            raise ValueError("changes of the timestep are not in the order of steps")
        last = change[0]
        changes.append((last, timestep_of(change[1])))
    return changes


def names_of(given: object) -> list[str]:
    """Return the names of bodies that a log gives. ValueError else."""
    if not isinstance(given, list) or not all(isinstance(name, str) for name in given):
        raise ValueError("the names of bodies are no list of texts")
    return given


def reasons_of(given: object) -> dict[str, str]:
    """Return by topic why a log does without it. ValueError else."""
    if not isinstance(given, dict) or not all(isinstance(why, str) for why in given.values()):
        raise ValueError("the topics that it does without are no names with reasons")
    return given


def check_counts(counts: Iterable[int], columns: int, stored: int) -> None:
    """Raise ValueError where contacts of some steps are not as many as their bytes.

    columns: of each contact, of eight bytes; stored: bytes of all columns.
    """
    counts = [int(count) for count in counts]  # of any size: sums of int64 may wrap
    if any(count < 0 for count in counts) or 8 * columns * sum(counts) != stored:
        raise ValueError("contacts are not as many as their bytes")
    if not columns and any(counts):
        raise ValueError("contacts have no columns")


@lru_cache(maxsize=64)  # the logs of a sweep mostly have the same
def clock_of(timestep: str, changes: str) -> Clock:
    """Return the times of the steps of a log; changes of the timestep as JSON."""
    clock = Clock.counted(timestep_of(timestep), changes_of(json.loads(changes)))
    if clock.stretches[-1].begin.denominator.bit_length() > MOST_BITS:
        raise ValueError("its times are no simple ratios")
    return clock
