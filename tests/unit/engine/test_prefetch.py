"""Asking for a record changes nothing, and asks for the lines that are meant."""

from __future__ import annotations

import re

import numba
import numpy as np
import pytest

from lavendersim.engine.prefetch import LINE, make_prefetch_span, prefetch, prefetch_impulses

FIELDS = [(f"f{k}", "f8") for k in range(20)]
# impulses at bytes 0, 160 and 168: two lines of a record of 176 bytes, which has three
RECORD = np.dtype([("lambda_n", "f8"), *FIELDS[:19], ("lambda_1", "f8"), ("push", "f8")])


# From byte 40 to byte 160, which a record has in three lines at most; of the absent field nothing.
ask_between = make_prefetch_span(("f4", "lambda_1", "absent"))


@pytest.mark.parametrize(
    ("ask", "lines"), [(prefetch, 3), (prefetch_impulses, 2), (ask_between, 3)]
)
def test_lines_are_asked_for_and_nothing_else_happens(ask, lines: int) -> None:
    assert RECORD.itemsize == 176 <= 3 * LINE

    @numba.njit
    def walk(records):
        for k in range(records.shape[0]):
            ask(records, min(k + 4, records.shape[0] - 1))

    rows = np.arange(22 * 5, dtype=np.float64).view(RECORD)
    before = rows.tobytes()
    walk(rows)
    assert rows.tobytes() == before
    (text,) = walk.inspect_llvm().values()
    body = text[text.index("define") :]
    calls = len(re.findall(r"call void @llvm\.prefetch", body))
    assert calls > 0
    assert calls % lines == 0  # the loop may be unrolled
    places = {int(b) for b in re.findall(r"i32 (\d+), i32 3, i32 1\)", body)}
    assert places == {1}  # to be written
