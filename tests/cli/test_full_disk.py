"""On a full disk an earlier figure stays, and the verb says which file could not be written."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest
from damaged_runs import DRAWN, made, verb

from tests.file_calls import FileCalls


def test_plot_on_a_full_disk_leaves_the_earlier_picture(tmp_path: Path) -> None:
    run = made(DRAWN, tmp_path)
    earlier = {}
    for picture in (run / "figures").iterdir():
        picture.write_bytes(b"earlier")
        earlier[picture] = b"earlier"
    for number in itertools.count():
        calls = FileCalls(number)
        with pytest.MonkeyPatch.context() as patch:
            calls.watch(patch)
            done = verb("plot", run)
        if done.code == 0:
            break
        renamed = any(call.name == "replace" for call in calls.made[:number])
        assert done.code == 6
        assert "no space left on device" in done.stderr
        assert done.stderr.startswith(str(run / "figures"))
        found = {picture: picture.read_bytes() for picture in (run / "figures").iterdir()}
        assert found.keys() == earlier.keys()
        if not renamed:
            assert found == earlier
        assert all(data == b"earlier" or len(data) > 1000 for data in found.values())
    assert number > 6
