"""Lines of how cells ended: appended whole, read up to the last whole one."""

from __future__ import annotations

from pathlib import Path

import pytest

from lavendersim.runner.run_index import (
    ENDED,
    append_line,
    as_row,
    digest_of,
    drop_cut_line,
    ended_rows,
    kept_lines,
    logs_closed,
    note_ended,
)
from lavendersim.trace import LogDigest

DIGEST = LogDigest(1234, 0xAB, "0" * 64)


def test_a_digest_comes_back_from_its_row() -> None:
    row = as_row(DIGEST)
    assert row == {"bytes": 1234, "crc32": "000000ab", "sha256": "0" * 64}
    assert digest_of(row) == DIGEST
    assert as_row(None) is None
    assert digest_of(None) is None


def test_the_last_line_about_a_log_counts(tmp_path: Path) -> None:
    for status in ("diverged", "complete"):
        note_ended(tmp_path / "cells" / "a.mcap", status, DIGEST)
    note_ended(tmp_path / "cells" / "b.mcap", "complete", DIGEST)
    rows = ended_rows(tmp_path)
    assert {name: row["status"] for name, row in rows.items()} == {
        "a.mcap": "complete",
        "b.mcap": "complete",
    }


def test_cells_that_a_signal_ended_have_not_ended_by_themselves(tmp_path: Path) -> None:
    for name, status in (("a", "complete"), ("b", "interrupted by SIGINT"), ("c", "diverged")):
        note_ended(tmp_path / "cells" / name, status, DIGEST)
    assert logs_closed(tmp_path) == {"a", "c"}


def test_without_a_file_none_has_ended(tmp_path: Path) -> None:
    assert ended_rows(tmp_path) == {}
    drop_cut_line(tmp_path)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("cut", range(1, 30, 7))
def test_a_line_that_a_kill_cut_is_not_counted_and_none_stands_behind_it(
    tmp_path: Path, cut: int
) -> None:
    for name in ("a.mcap", "b.mcap"):
        append_line(tmp_path / ENDED, {"file": name})
    path = tmp_path / ENDED
    path.write_bytes(path.read_bytes()[: -min(cut, 19)])
    assert list(ended_rows(tmp_path)) == ["a.mcap"]
    drop_cut_line(tmp_path)
    append_line(path, {"file": "c.mcap"})
    assert list(ended_rows(tmp_path)) == ["a.mcap", "c.mcap"]


def test_lines_that_are_kept_are_whole_and_once_each(tmp_path: Path) -> None:
    for name in ("a", "b", "a", "c"):
        append_line(tmp_path / ENDED, {"file": name})
    assert kept_lines(tmp_path, {"a", "c"}) == '{"file": "a"}\n{"file": "c"}\n'
