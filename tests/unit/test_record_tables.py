"""Tables of records moved as bytes are what numpy makes of them field by field."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.record_tables import ROOM_FOR_TIME, copied, joined, widened, with_room

ROW = np.dtype([("a", "f8"), ("b", "i8"), ("c", "u8")])


def table(count: int, seed: int = 0) -> np.ndarray:
    """Return rows of every bit pattern."""
    words = np.random.default_rng(seed).integers(0, 2**64 - 1, (count, 3), np.uint64)
    return words.view(ROW)[:, 0]


@pytest.mark.parametrize("count", [0, 1, 50])
def test_a_copy_has_the_bytes_and_shares_none(count: int) -> None:
    rows = table(count)
    copy = copied(rows)
    assert copy.dtype == ROW
    assert copy.tobytes() == rows.tobytes()
    assert not np.shares_memory(copy, rows)
    assert copied(table(100)[::2][:count]).tobytes() == table(100)[::2][:count].tobytes()


@pytest.mark.parametrize("count", [0, 1, 50])
def test_a_row_may_have_room_behind_it(count: int) -> None:
    """What stands there is copied along, and is no column."""
    rows, roomy = table(count), with_room(ROW)
    copy = copied(widened(rows, roomy))
    assert copy.dtype == roomy
    assert (roomy.names, roomy.itemsize) == (ROW.names, ROW.itemsize + ROOM_FOR_TIME)
    wide = copy.view(np.dtype([*ROW.descr, ("behind", "i8")]))
    wide["behind"] = -1
    for name in ROW.names or ():
        assert copy[name].tobytes() == rows[name].tobytes()
    assert not np.shares_memory(copy, rows)


@pytest.mark.parametrize("counts", [(3,), (0, 5), (4, 0, 2)])
def test_joined_tables_stand_one_after_the_other(counts: tuple[int, ...]) -> None:
    tables = [table(count, seed) for seed, count in enumerate(counts)]
    whole = joined(tables)
    assert whole.dtype == ROW
    assert whole.tobytes() == b"".join(one.tobytes() for one in tables)


def test_tables_of_other_columns_are_not_joined() -> None:
    with pytest.raises(TypeError, match="tables of different columns"):
        joined([table(2), table(2).astype([("a", "f8"), ("b", "i8"), ("d", "u8")])])


@pytest.mark.parametrize("count", [0, 1, 50])
def test_a_wider_table_begins_with_the_same_columns(count: int) -> None:
    rows = table(count)
    wide = widened(rows, np.dtype([*ROW.descr, ("time", "f8")]))
    for name in ROW.names or ():
        assert wide[name].tobytes() == rows[name].tobytes()


def test_a_column_in_another_place_is_refused() -> None:
    with pytest.raises(TypeError, match="column a has another place"):
        widened(table(2), np.dtype([("time", "f8"), *ROW.descr]))
