"""The digest of a log is that of its file, however its bytes came."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest
from sample import AS_WRITTEN, CONFIG, METADATA, run

from lavendersim.trace import TraceWriter
from lavendersim.trace.file_digest import BESIDE, FileDigest


@pytest.mark.parametrize("size", [0, 1, BESIDE // 3, BESIDE, 2 * BESIDE + 1])
def test_parts_of_every_size_give_the_digest_of_all_bytes(size: int) -> None:
    parts = [bytes([number]) * size for number in range(7)]
    digest = FileDigest()
    for part in parts:
        digest.update(part)
    assert digest.hexdigest() == hashlib.sha256(b"".join(parts)).hexdigest()


def test_a_closed_log_has_the_digest_of_its_file(tmp_path: Path) -> None:
    writer = TraceWriter(tmp_path / "log.mcap", CONFIG, AS_WRITTEN, METADATA)
    for block in (run(300),):
        writer.append(block)
    found = writer.close("complete").digest
    data = (tmp_path / "log.mcap").read_bytes()
    assert (found.size, found.sha256) == (len(data), hashlib.sha256(data).hexdigest())
