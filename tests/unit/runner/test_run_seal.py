"""The seal of a run has the digest of each of its tables, in the form of sha256sum."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

from lavendersim.errors import TraceError
from lavendersim.runner.run_seal import DONE, read_sealed, seal_of, sealed


@pytest.fixture
def run(tmp_path: Path) -> Path:
    (tmp_path / "cells.json").write_text("{}")
    (tmp_path / "results.json").write_text("[1]")
    (tmp_path / DONE).write_text(seal_of(tmp_path, ["cells.json", "absent.csv", "results.json"]))
    return tmp_path


def test_a_line_is_digest_two_spaces_name(run: Path) -> None:
    first = (run / DONE).read_text().splitlines()[0]
    assert first == f"{hashlib.sha256(b'{}').hexdigest()}  cells.json"


def test_files_that_are_not_there_have_no_line(run: Path) -> None:
    assert list(sealed(run)) == ["cells.json", "results.json"]
    assert read_sealed(run / "results.json") == b"[1]"


def test_a_table_that_was_changed_or_is_missing_is_reported(run: Path) -> None:
    (run / "results.json").write_text("[2]")
    with pytest.raises(TraceError, match=r"results\.json: changed since the run wrote it"):
        read_sealed(run / "results.json")
    (run / "cells.json").unlink()
    with pytest.raises(TraceError, match=r"cells\.json: missing"):
        read_sealed(run / "cells.json")


def test_a_table_under_no_seal_is_read_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "cells.json").write_text("{}")
    assert sealed(tmp_path) == {}
    assert read_sealed(tmp_path / "cells.json") == b"{}"


@pytest.mark.parametrize("line", ["cells.json", "0" * 63 + "  a", "0" * 64 + " a", "\xff"])
def test_a_damaged_seal_is_reported(tmp_path: Path, line: str) -> None:
    (tmp_path / DONE).write_text(line + "\n", encoding="latin-1")
    with pytest.raises(TraceError, match="a line of it has no digest"):
        sealed(tmp_path)
