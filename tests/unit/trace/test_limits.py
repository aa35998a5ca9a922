"""What a log may claim of itself, at the edges."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
import zstandard
from mcap.records import Chunk

from lavendersim.trace.limits import (
    FREE_BYTES,
    MOST_GROWTH,
    changes_of,
    check_chunk,
    check_counts,
    check_growth,
    claimed_by,
    names_of,
    reasons_of,
    timestep_of,
)


@pytest.mark.parametrize(("text", "timestep"), [("1/480", Fraction(1, 480)), ("2", Fraction(2))])
def test_a_timestep_is_a_ratio(text: str, timestep: Fraction) -> None:
    assert timestep_of(text) == timestep


@pytest.mark.parametrize(
    "given", ["1/0", "0", "-1/2", "0.1", "1e-3", "", None, 0.1, "1" * 1001, "1" * 11, "1/480 "]
)
def test_what_is_no_timestep(given: object) -> None:
    with pytest.raises(ValueError, match="a timestep"):
        timestep_of(given)


def test_changes_stand_in_the_order_of_their_steps() -> None:
    assert changes_of([[0, "1/2"], [5, "1/4"]]) == [(0, Fraction(1, 2)), (5, Fraction(1, 4))]
    assert changes_of([]) == []


@pytest.mark.parametrize(
    "given",
    [
        *(None, {}, [[5, "1/2"], [5, "1/4"]], [[-1, "1/2"]], [[2**63, "1/2"]]),
        *([[True, "1/2"]], [[1]], ["12"], [[1, 0.5]]),
    ],
)
def test_what_are_no_changes(given: Any) -> None:
    with pytest.raises(ValueError, match="timestep"):
        changes_of(given)


def test_growth_up_to_a_thousand_times_beyond_what_is_free() -> None:
    check_growth(FREE_BYTES, 1, "a chunk")
    many = FREE_BYTES  # stored
    check_growth(MOST_GROWTH * many, many, "a chunk")
    with pytest.raises(ValueError, match="a chunk of 1 bytes would be"):
        check_growth(FREE_BYTES + 1, 1, "a chunk")


def test_a_chunk_claims_what_its_compressed_bytes_say() -> None:
    data = zstandard.compress(b"x" * 1000)

    def chunk(claimed: int) -> Chunk:
        return Chunk("zstd", data, 0, 0, 0, claimed)

    check_chunk(chunk(1000))
    assert claimed_by(chunk(7)) == 1000
    with pytest.raises(ValueError, match="claims 1001 bytes, its compressed data 1000"):
        check_chunk(chunk(1001))
    assert claimed_by(Chunk("zstd", b"no zstd", 0, 0, 0, 9)) == 0


def test_contacts_are_as_many_as_their_bytes() -> None:
    check_counts([2, 0, 1], 5, 8 * 5 * 3)
    check_counts([0, 0], 0, 0)
    # 2^61 contacts of 8 bytes are 0 bytes in 64 bits.
    for counts, columns, stored in (
        ([2, 1], 5, 8 * 5 * 3 + 8),
        ([-1, 4], 5, 8 * 5 * 3),
        ([2**61], 1, 0),
        ([1], 0, 0),
    ):
        with pytest.raises(ValueError, match="contacts"):
            check_counts(counts, columns, stored)


def test_names_and_reasons_are_texts() -> None:
    assert names_of(["a", "b"]) == ["a", "b"]
    assert reasons_of({"/tf": "why"}) == {"/tf": "why"}
    for given in ({"a": 1}, "ab", [1], None):
        with pytest.raises(ValueError, match="names"):
            names_of(given)
    for given in ({"/tf": 1}, ["a"], None):
        with pytest.raises(ValueError, match="topics"):
            reasons_of(given)
