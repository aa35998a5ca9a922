"""The index of a run that was killed has every cell that had ended, with the digest of its log."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from small_configs import DROPS, write

from lavendersim.errors import TraceError
from lavendersim.runner.run_directory import Run, list_runs
from lavendersim.trace import check_closed

CELLS = 400
SWEPT = DROPS.replace(
    "values: [0.2, 0.5, 0.8]", f"values: {[round(0.1 + i / 1000, 4) for i in range(CELLS)]}"
)
RUN = """
import sys
import lavendersim.runner.executor as executor
from pathlib import Path
import lavendersim
if __name__ == "__main__":
    executor.WORTH_PROCESSES = -1.0
    lavendersim.run(Path(sys.argv[1]), root=Path(sys.argv[2]), jobs=int(sys.argv[3]))
"""


def killed(folder: Path, jobs: int) -> Run:
    """Return a run that was killed when some of its cells had ended."""
    script = folder / "script.py"
    script.write_text(RUN)
    arguments = [script, write(folder, SWEPT), folder / "runs", jobs]
    process = subprocess.Popen([sys.executable, *map(str, arguments)])
    try:
        while process.poll() is None:
            notes = list((folder / "runs").glob("*/ended.jsonl"))
            if notes and notes[0].read_bytes().count(b'"measured"') > CELLS // 10:
                break
            time.sleep(0.002)
    finally:
        process.send_signal(signal.SIGKILL)
        process.wait()
    (run,) = list_runs(folder / "runs")
    return run


def is_closed(log: Path) -> bool:
    try:
        check_closed(log)
    except TraceError:
        return False
    return True


@pytest.mark.parametrize("jobs", [1, 2])
def test_after_a_kill_whole_logs_are_indexed_as_ended(tmp_path: Path, jobs: int) -> None:
    run = killed(tmp_path, jobs)
    assert not run.finished
    ended = [cell for cell in run.cells if cell.status == "complete"]
    whole = [cell for cell in run.cells if is_closed(cell.path)]
    assert CELLS // 10 < len(ended) < CELLS
    # each process may die between the last byte of a log and the line about it
    assert len(whole) - len(ended) <= jobs
    for cell in ended:
        assert cell.expected is not None
        assert cell.expected.digest is not None
        assert cell.damage() == ""


def test_a_line_that_a_kill_cut_is_not_counted_and_a_damaged_one_is_refused(
    tmp_path: Path,
) -> None:
    row = {"index": 0, "label": "", "file": "cells/a.mcap", "status": "pending", "log": None}
    (tmp_path / "cells.json").write_text(json.dumps({"experiment": "drop", "cells": [row]}))
    line = json.dumps({"file": "a.mcap", "status": "complete", "log": None})
    for text, status in ((line, "pending"), (line + "\n", "complete"), (line + "\n{", "complete")):
        (tmp_path / "ended.jsonl").write_text(text)
        assert Run(tmp_path).index_rows()[0].status == status
    (tmp_path / "ended.jsonl").write_text(line[1:] + "\n")
    with pytest.raises(TraceError, match=r"ended\.jsonl: damaged"):
        Run(tmp_path).index_rows()
