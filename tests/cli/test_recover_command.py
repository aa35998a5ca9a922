"""`lavender recover`: several logs and runs, no file that exists; whole, part and nothing."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from command_line import lavender
from damaged_runs import DRAWN, copied, cut, flip, logs, made, verb

from lavendersim.trace import open_trace
from lavendersim.trace.index import read_summary

WHOLE, PART, NOTHING = 0, 3, 5


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished run of two cells."""
    return made(DRAWN, tmp_path_factory.mktemp("whole"))


@pytest.fixture
def run(whole: Path, tmp_path: Path) -> Path:
    """A copy of it, to be damaged."""
    return copied(whole, tmp_path)


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_several_logs_are_recovered_beside_themselves_and_none_is_overwritten(run: Path) -> None:
    """The second log was once taken for the output, and replaced."""
    for log in logs(run):
        cut(log, 0.8)
    before = contents(run / "cells")
    done = verb("recover", *logs(run))
    assert done.code == PART
    after = contents(run / "cells")
    assert before.items() <= after.items()
    new = sorted(after.keys() - before.keys())
    assert new == sorted(name.replace(".mcap", ".recovered.mcap") for name in before)
    for name in new:
        assert 0 < len(open_trace(run / "cells" / name, allow_incomplete=True).step) < 961


def test_a_whole_run_is_recovered_in_place(run: Path) -> None:
    damaged, good = logs(run)
    cut(damaged, 0.8)
    done = verb("recover", run)
    assert done.code == PART
    assert f"{good}: left as it is, whole: 961 steps up to t = 4 s\n" in done.stdout
    assert f"{damaged.with_suffix('.recovered.mcap')}: part: " in done.stdout
    assert f"{damaged}: lost: what followed step " in done.stderr
    again = verb("recover", run)
    assert again.code == 2
    assert "exists already" in again.stderr


@pytest.mark.parametrize("which", ["the log", "another log", "a picture"])
def test_no_file_that_exists_is_written_to(run: Path, which: str) -> None:
    damaged, good = logs(run)
    cut(damaged, 0.8)
    out = {"the log": damaged, "another log": good, "a picture": run / "figures" / "drop.png"}
    before = contents(run / "cells")
    done = verb("recover", damaged, "--output", out[which])
    assert (done.code, done.stdout) == (2, "")
    assert len(done.stderr.splitlines()) == 1
    assert contents(run / "cells") == before


def test_one_output_is_for_one_log(run: Path, tmp_path: Path) -> None:
    done = verb("recover", *logs(run), "--output", tmp_path / "out.mcap")
    assert (done.code, done.stdout) == (2, "")
    assert done.stderr == "--output is for one log, and these are 2\n"


def test_exit_codes_tell_whole_part_and_nothing_apart(run: Path, tmp_path: Path) -> None:
    log = logs(run)[0]
    data = log.read_bytes()
    out = tmp_path / "out.mcap"
    log.write_bytes(data[:-100])  # in its summary
    assert verb("recover", log, "-o", out).code == WHOLE
    assert out.read_bytes() == data
    assert open_trace(out).status == "complete"
    out.unlink()
    log.write_bytes(data)
    flip(log, read_summary(log).chunks[5].chunk_start_offset + 80)
    done = verb("recover", log, "-o", out)
    assert done.code == PART
    assert "lost: steps " in done.stderr
    out.unlink()
    log.write_bytes(bytes(1000))
    done = verb("recover", log, "-o", out)
    assert (done.code, done.stdout) == (NOTHING, "")
    assert done.stderr == f"{log}: nothing to save, no group of steps is whole\n"
    assert not out.exists()
    # Of several logs it is the worst.
    shutil.copy(logs(run)[1], tmp_path / "good.mcap")
    assert verb("recover", log, tmp_path / "good.mcap").code == NOTHING
    assert verb("recover", tmp_path / "good.mcap").code == WHOLE


def test_a_log_that_is_not_there_is_a_usage_error_and_a_damaged_one_is_not(tmp_path: Path) -> None:
    done = lavender("recover", "none.mcap", where=tmp_path)
    assert (done.returncode, done.stderr) == (2, "none.mcap: no such log\n")
    done = lavender("recover", ".", where=tmp_path)
    assert (done.returncode, done.stderr) == (2, ".: not the directory of a run\n")
    (tmp_path / "noise.mcap").write_bytes(bytes(100))
    done = lavender("recover", "noise.mcap", where=tmp_path)
    assert done.returncode == NOTHING
    assert done.stderr.startswith("noise.mcap: ")
    assert len(done.stderr.splitlines()) == 1


def test_a_run_that_was_killed_has_no_logs_of_cells_that_never_began(run: Path) -> None:
    index = (run / "cells.json").read_text()
    (run / "cells.json").write_text(index.replace('"complete"', '"pending"'))
    (run / "DONE").unlink()
    logs(run)[0].unlink()
    cut(logs(run)[0], 0.8)
    done = verb("recover", run)
    assert done.code == PART
    assert len(done.stdout.splitlines()) == 1


def test_a_recovered_log_in_place_of_the_damaged_one_is_drawn_on_request_alone(run: Path) -> None:
    log = logs(run)[0]
    cut(log, 0.8)
    assert verb("recover", log).code == PART
    log.with_suffix(".recovered.mcap").replace(log)
    done = verb("plot", run)
    assert done.code == PART
    assert "recovered: " in done.stderr
    assert verb("plot", run, "--allow-incomplete").code == PART
