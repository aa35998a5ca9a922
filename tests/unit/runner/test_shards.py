"""A sweep that is run in shards, by workers that come, go and die, is one that one process ran.

`LAVENDER_TEST_KILLS` kills workers in more rounds than one.
"""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from shards_made import merged, shard

from lavendersim.errors import UsageError
from lavendersim.runner import Finished, run
from lavendersim.runner.merge import Missing, merge
from lavendersim.runner.shards import part_of
from tests.forked_python import python
from tests.runner.run_contents import contents
from tests.runner.small_configs import DROPS, write

KILLS = int(os.environ.get("LAVENDER_TEST_KILLS", "1"))
WORKERS = 8
MANY = DROPS.replace("[0.2, 0.5, 0.8]", str([round(0.1 + i / 100, 2) for i in range(80)]))


@pytest.fixture
def drops(tmp_path: Path) -> Path:
    return write(tmp_path)


def test_a_worker_that_joins_runs_what_nobody_has(drops: Path, tmp_path: Path) -> None:
    into = tmp_path / "shared"
    shard(drops, into, (2, 3))
    joined = shard(drops, into)
    assert (joined.ran, joined.ended, joined.cells) == (2, 3, 3)
    assert shard(drops, into).ran == 0
    assert shard(drops, into, (1, 3)).ran == 0
    assert contents(merged(into)) == contents(run(drops, tmp_path / "whole").run)


def test_a_part_whose_last_note_was_cut_is_gone_on_with(drops: Path, tmp_path: Path) -> None:
    into = tmp_path / "shared"
    first = shard(drops, into, (1, 1)).shard
    notes = first / "ended.jsonl"
    notes.write_bytes(notes.read_bytes()[:-20])
    again = shard(drops, into, (1, 1))
    assert (again.ran, again.measured, again.ended) == (0, 1, 3)
    assert contents(merged(into)) == contents(run(drops, tmp_path / "whole").run)


@pytest.mark.parametrize("what", ["config", "engine", "versions"])
def test_shards_of_another_config_or_engine_are_refused(
    drops: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, what: str
) -> None:
    into = tmp_path / "shared"
    first = shard(drops, into, (1, 3)).shard
    if what == "config":
        drops.write_text(DROPS + "# another\n")
    elif what == "engine":
        hashes = "lavendersim.engine.sources.source_hash"
        monkeypatch.setattr(hashes, lambda: "another")
    else:
        monkeypatch.setattr("lavendersim.runner.environment.versions", lambda: {"numba": "0"})
    said = f"{first}: a shard of (another|other) {what}; every sweep needs a folder of its own"
    with pytest.raises(UsageError, match=said):
        shard(drops, into, (2, 3))
    assert [path.name for path in (into / "shards").iterdir()] == ["1-of-3"]
    shard(drops, tmp_path / "other", (2, 3)).shard.rename(into / "shards" / "2-of-3")
    with pytest.raises(UsageError, match=f"a shard of (another|other) {what}"):
        merge(into, tmp_path / "runs")


@pytest.mark.parametrize("text", ["0/3", "4/3", "3", "1/0", "-1/3", "1/3/5", "one/two"])
def test_a_part_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="expected K/N with K from 1 to N"):
        part_of(text)


def begin(config: Path, into: Path) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "lavender_cli.main", "run", config, "--into", into]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@pytest.mark.skipif(os.name != "posix", reason="kills as POSIX does")
def test_workers_that_are_killed_lose_no_cell(tmp_path: Path) -> None:
    config, into = write(tmp_path, MANY), tmp_path / "shared"
    whole = contents(run(config, tmp_path / "whole").run)  # leaves the kernel for the workers
    draw = random.Random(7)
    for _ in range(KILLS):
        workers = [begin(config, into) for _ in range(WORKERS if KILLS > 1 else WORKERS // 2)]
        while not list(into.glob("shards/*/cells/*")):
            time.sleep(0.001)
        for worker in workers:
            time.sleep(draw.uniform(0.0, 0.1))
            worker.send_signal(signal.SIGKILL)
        for worker in workers:
            worker.wait()
    assert isinstance(merge(into, tmp_path / "early"), Missing | Finished)
    for worker in [begin(config, into) for _ in range(WORKERS // 4)]:
        assert worker.wait() == 0
    shard(config, into)  # what a worker had that was killed while the last ones ended
    assert contents(merged(into)) == whole


def test_the_commands_exit_as_scripts_expect(drops: Path, tmp_path: Path) -> None:
    def lavender(*words: object) -> tuple[int, str]:
        done = python("-m", "lavender_cli.main", *words, where=tmp_path)
        return done.returncode, done.stdout + done.stderr

    into = tmp_path / "shared"
    assert lavender("merge", into)[0] == 2
    assert lavender("run", drops, "--shard", "1/2")[0] == 2
    code, said = lavender("run", drops, "--shard", "1/2", "--into", into, "--plot")
    assert code == 2
    assert "--plot with --into: cells are not judged before `lavender merge`" in said
    assert not into.exists()
    assert lavender("run", drops, "--shard", "1/2", "--into", into)[0] == 0
    code, said = lavender("merge", into)
    assert code == 3
    assert "missing: e=0.5" in said
    assert "1 of 3 cells are missing; go on with: lavender run CONFIG --into" in said
    assert lavender("run", drops, "--shard", "2/2", "--into", into)[0] == 0
    code, said = lavender("merge", into, "--plot")
    assert code == 0, said
    assert "pass  rebound" in said
    assert len(list((tmp_path / "runs" / "latest" / "figures").iterdir())) == 2
