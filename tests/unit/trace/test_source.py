"""A log that was just written is read from memory: the same columns, and no byte of the file."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from sample import AS_WRITTEN, CONFIG, METADATA, run

from lavendersim.cell import CellConfig
from lavendersim.errors import TraceError
from lavendersim.trace import Trace, TraceWriter, Written, open_trace, trace_of, writer
from lavendersim.trace.source import FORMER_RESOLVED

MANY = 3000  # several chunks of either stream


def written(path: Path, steps: int) -> Written:
    """Write a log of some steps."""
    log = TraceWriter(path, CONFIG, AS_WRITTEN, METADATA)
    log.append(run(steps))
    return log.close("complete")


def assert_equal(one: Trace, other: Trace) -> None:
    """Hold every column and every word of two logs against each other."""
    for column in ("step", "contact", "residual"):
        left, right = getattr(one, column), getattr(other, column)
        assert left.dtype.names == right.dtype.names
        for name in left.dtype.names:
            assert left.dtype[name] == right.dtype[name]
            assert left[name].tobytes() == right[name].tobytes()
    assert one.pose.tobytes() == other.pose.tobytes()
    assert (one.metadata, one.status, one.bodies) == (other.metadata, other.status, other.bodies)
    assert (one.config, one.as_written) == (other.config, other.as_written)
    assert one.timesteps.tobytes() == other.timesteps.tobytes()


@pytest.mark.parametrize("steps", [1, 40, MANY])
def test_a_log_in_memory_is_the_log_on_disk(tmp_path: Path, steps: int) -> None:
    log = written(tmp_path / "run.mcap", steps)
    assert_equal(trace_of(log), open_trace(log.path))


def test_a_log_in_memory_needs_no_file(tmp_path: Path) -> None:
    log = written(tmp_path / "run.mcap", 40)
    truth = open_trace(log.path)
    step, pose, contact = truth.step, truth.pose, truth.contact
    log.path.unlink()
    kept = trace_of(log)
    assert kept.step.tobytes() == step.tobytes()
    assert kept.pose.tobytes() == pose.tobytes()
    for name in contact.dtype.names or ():
        assert kept.contact[name].tobytes() == contact[name].tobytes()


def test_a_log_too_large_to_keep_is_read_from_its_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(writer, "KEPT_BYTES", 1000)
    log = written(tmp_path / "run.mcap", MANY)
    assert log.blocks is None
    assert_equal(trace_of(log), open_trace(log.path))


def test_a_log_that_changed_after_it_was_written_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also in a chunk that nobody asks for."""
    monkeypatch.setattr(writer, "KEPT_BYTES", 1000)
    log = written(tmp_path / "run.mcap", MANY)
    data = bytearray(log.path.read_bytes())
    data[len(data) // 3] ^= 1
    log.path.write_bytes(data)
    for trace in (trace_of(log), open_trace(log.path)):
        with pytest.raises(TraceError, match="fail the CRC"):
            _ = trace.step


def test_the_config_of_an_older_log_is_read_from_its_yaml(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = yaml.safe_dump(CONFIG.as_dict(), sort_keys=False)
    with monkeypatch.context() as patch:
        patch.setattr(writer, "RESOLVED", FORMER_RESOLVED)
        patch.setattr(CellConfig, "as_json", lambda self: text)
        path = written(tmp_path / "run.mcap", 3).path
    assert open_trace(path).config == CONFIG
