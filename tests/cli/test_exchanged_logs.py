"""A whole log that is not the one written of its cell is refused by every verb that reads it."""

from __future__ import annotations

import shutil
import zlib
from pathlib import Path

import pytest
from damaged_runs import DRAWN, copied, cut, logs, made, verb

from lavendersim import open_run
from lavendersim.errors import TraceError
from lavendersim.figures import write_report
from lavendersim.runner import run as run_experiment
from lavendersim.trace import check_closed
from lavendersim.trace.whole import check_bytes
from tests.older_runs import without_digests

# Generator of CRC-32, highest degree first. A message to which a multiple of it is added has the
# CRC that it had before.
GENERATOR = f"1{0x04C11DB7:032b}"


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished run of two cells, with its figure."""
    return made(DRAWN, tmp_path_factory.mktemp("whole"))


def exchanged(run: Path) -> None:
    one, other = logs(run)
    aside = one.with_suffix(".aside")
    one.rename(aside)
    other.rename(one)
    aside.rename(other)


def of_another_experiment(run: Path) -> None:
    strange = made(DRAWN.replace("mass: 1.0", "mass: 2.0"), run.parent)
    for own, other in zip(logs(run), logs(strange), strict=True):
        shutil.copy(other, own)
    shutil.rmtree(strange)


@pytest.fixture(params=[exchanged, of_another_experiment])
def strange(request: pytest.FixtureRequest, whole: Path, tmp_path: Path) -> Path:
    """A run whose logs are whole, and not those of their cells."""
    run = copied(whole, tmp_path)
    request.param(run)
    return run


def test_a_strange_log_is_refused_by_every_verb_that_reads_it(
    strange: Path, tmp_path: Path
) -> None:
    figures = {path: path.read_bytes() for path in (strange / "figures").iterdir()}
    recording = tmp_path / "view.rrd"
    for arguments in (
        ("plot", strange),
        ("replay", strange, "--save", recording),
        ("replay", strange, "--save", recording, "--allow-incomplete"),
        ("show", strange),
        ("show", strange, "--json"),
        ("ls", "--runs", strange.parent),
    ):
        done = verb(*arguments)
        assert done.code == 3, arguments
        assert "not the log that its run wrote there" in done.stderr or (
            "the log of another cell" in done.stderr
        )
        assert "Traceback" not in done.stderr
    assert not recording.exists()
    assert {path: path.read_bytes() for path in (strange / "figures").iterdir()} == figures
    drawn = verb("plot", strange, "--allow-incomplete")  # marked, and without these cells
    assert drawn.code == 3
    assert "the log of another cell" in drawn.stderr


@pytest.mark.parametrize("allowed", [False, True])
def test_a_cell_of_the_python_interface_refuses_a_strange_log(strange: Path, allowed: bool) -> None:
    for cell in open_run(strange, allow_incomplete=allowed).cells:
        with pytest.raises(TraceError, match=r"not the log that|the log of another cell"):
            cell.trace()
        assert cell.damage()


def test_checks_report_and_plugin_refuse_a_log_that_was_exchanged_since_it_was_written(
    tmp_path: Path,
) -> None:
    (tmp_path / "drop.yaml").write_text(DRAWN)
    finished = run_experiment(tmp_path / "drop.yaml", tmp_path / "runs")
    assert finished.run.cut() == []  # what the plugin asks
    exchanged(finished.run.path)
    assert len(finished.run.cut()) == 2
    assert len(write_report([finished], tmp_path / "report.html")) == 2
    assert "not the log that its run wrote there" in (tmp_path / "report.html").read_text()


@pytest.mark.parametrize("allowed", [False, True])
def test_of_a_cut_log_of_another_cell_nothing_is_read(
    whole: Path, tmp_path: Path, allowed: bool
) -> None:
    run = copied(whole, tmp_path)
    exchanged(run)
    cut(logs(run)[0], 0.9)
    (cell,) = (c for c in open_run(run, allow_incomplete=allowed).cells if c.path == logs(run)[0])
    with pytest.raises(TraceError, match="the log of another cell" if allowed else "unfinished"):
        cell.trace()


def test_a_change_that_keeps_size_and_crc_is_seen_by_the_digest(
    whole: Path, tmp_path: Path
) -> None:
    run = copied(whole, tmp_path)
    (cell,) = (cell for cell in open_run(run).cells if cell.path == logs(run)[0])
    data = bytearray(cell.path.read_bytes())
    crc = zlib.crc32(data[:5000])
    for place, bit in enumerate(GENERATOR):  # the first bit of a message is the lowest of a byte
        data[1000 + place // 8] ^= int(bit) << place % 8
    assert zlib.crc32(data[:5000]) == crc
    cell.path.write_bytes(data)
    check_bytes(cell.path)
    assert cell.expected is not None
    check_closed(cell.path, cell.expected.digest)
    with pytest.raises(TraceError, match="it has the SHA-256"):
        check_bytes(cell.path, cell.expected.digest)
    with pytest.raises(TraceError, match="it has the SHA-256"):
        cell.trace().step  # noqa: B018 - a column is read
    assert verb("plot", run).code == 3


def test_an_older_run_without_digests_is_read_as_before(whole: Path, tmp_path: Path) -> None:
    run = copied(whole, tmp_path)
    without_digests(run)
    for arguments in (("plot", run), ("show", run), ("ls", "--runs", run.parent)):
        done = verb(*arguments)
        assert (done.code, done.stderr) == (0, "")
