"""What is appended is what is read, bit for bit, and equal runs are equal files."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import numpy.lib.recfunctions as recfunctions
import pytest
from sample import AS_WRITTEN, BODIES, CONFIG, METADATA, SCENE, TIMESTEP, run, split, write

from lavendersim.clock import Clock
from lavendersim.errors import TraceError
from lavendersim.trace import Block, Trace, TraceWriter, open_trace
from tests.made_cells import made_cell

# enough for several groups: a step is some 400 B of the light stream, a group 128 KiB
MANY = 900


def assert_holds(trace: Trace, block: Block) -> None:
    for table, written in zip(
        (trace.step, trace.contact, trace.residual),
        (block.step, block.contact, block.residual),
        strict=True,
    ):
        for name in written.dtype.names or ():
            assert table[name].tobytes() == written[name].tobytes(), name
    assert trace.pose.tobytes() == block.pose.tobytes()


def test_every_column_returns_bit_for_bit(tmp_path: Path) -> None:
    block = run(MANY)
    trace = open_trace(write(tmp_path / "run.mcap", [block]))
    assert_holds(trace, block)
    assert np.array_equal(trace.step["time"], block.step["time_ns"] / 1e9)
    assert len(trace.contact["time"]) == len(block.contact)


def test_what_describes_the_run_returns(tmp_path: Path) -> None:
    trace = open_trace(write(tmp_path / "run.mcap", [run(3)], "diverged: ball at step 2"))
    assert (trace.bodies, trace.timestep) == (BODIES, TIMESTEP)
    assert (trace.config, trace.as_written) == (CONFIG, AS_WRITTEN)
    assert trace.status == "diverged: ball at step 2"
    assert not trace.complete
    assert METADATA.items() <= trace.metadata.items()


def test_changes_of_the_timestep_return(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    clock = Clock.counted(TIMESTEP, [(2, Fraction(1, 3)), (7, Fraction(1, 1000))])
    # 2 / 240 s, and 5 / 3 s after them
    changes = [{"at": 0.0083, "timestep": "1/3"}, {"at": 1.675, "timestep": "1/1000"}]
    writer = TraceWriter(path, made_cell(SCENE, events=changes), AS_WRITTEN, METADATA)
    writer.append(run(10))
    writer.close("complete")
    trace = open_trace(path)
    assert trace.clock.stretches == clock.stretches
    assert trace.timestep == TIMESTEP
    lengths = [1 / 240] * 3 + [1 / 3] * 5 + [1 / 1000] * 2  # of step 0, that of the first
    assert trace.timesteps.tolist() == lengths


def test_a_log_of_one_timestep_is_as_all_logs_were(tmp_path: Path) -> None:
    trace = open_trace(write(tmp_path / "run.mcap", [run(3)]))
    assert "timestep_changes" not in trace.metadata["trace"]
    assert trace.clock.stretches == [(0, Fraction(0), TIMESTEP)]


@pytest.mark.parametrize("sizes", [[1] * 40, [100] * 8, [327, 1, 300]])
def test_the_bytes_do_not_depend_on_how_steps_are_split(tmp_path: Path, sizes: list[int]) -> None:
    block = run(MANY)
    whole = write(tmp_path / "whole.mcap", [block]).read_bytes()
    assert write(tmp_path / "split.mcap", split(block, sizes)).read_bytes() == whole


def test_extra_columns_pass_through(tmp_path: Path) -> None:
    block = run(50, extra=("slip_speed", "heat"))
    wider = np.zeros(50, [*block.step.dtype.descr, ("wear", "f8"), ("flags", "i8")])
    for name in block.step.dtype.names or ():
        wider[name] = block.step[name]
    wider["wear"], wider["flags"] = np.pi, -(2**60)
    block = block._replace(step=wider)
    assert_holds(open_trace(write(tmp_path / "run.mcap", [block])), block)


def test_absent_columns_stay_absent(tmp_path: Path) -> None:
    block = run(50)
    kept = ["step", "time_ns", "kinetic_energy"]
    block = block._replace(step=block.step[kept], contact=block.contact[["step", "x", "y", "z"]])
    trace = open_trace(write(tmp_path / "run.mcap", [block]))
    assert_holds(trace, block)
    assert trace.step.dtype.names == (*kept, "time")
    assert trace.contact.dtype.names == ("step", "x", "y", "z", "time")


def test_a_run_that_never_began_is_an_empty_log(tmp_path: Path) -> None:
    trace = open_trace(write(tmp_path / "run.mcap", [], "diverged: at once"))
    assert len(trace.step) == len(trace.contact) == len(trace.residual) == len(trace.pose) == 0


def test_reading_steps_leaves_the_bulk_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from lavendersim.trace import source

    touched: list[set[int]] = []
    real = source.read_chunk
    monkeypatch.setattr(
        source, "read_chunk", lambda s, e: touched.append({*e.message_index_offsets}) or real(s, e)
    )
    trace = open_trace(write(tmp_path / "run.mcap", [run(MANY)]))
    assert len(trace.step) == MANY
    assert touched
    assert not any(channels & {2, 3} for channels in touched)  # /tf, /contacts


@pytest.mark.parametrize("fault", ["steps go back", "a stray contact", "another column", "a pose"])
def test_a_block_that_contradicts_itself_is_refused(tmp_path: Path, fault: str) -> None:
    first, second = split(run(40), [20])
    if fault == "steps go back":
        second = first
    elif fault == "a stray contact":
        second.contact["step"][-1] = 99
    elif fault == "another column":
        second = second._replace(contact=second.contact[["step", "x", "y", "z"]])
    else:
        second = second._replace(pose=second.pose[:, :2])
    with pytest.raises(ValueError, match=r"."):
        write(tmp_path / "run.mcap", [first, second])


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match=r"none\.mcap: no such log"):
        open_trace(tmp_path / "none.mcap")


def test_a_column_that_was_renamed_is_read_from_older_logs(tmp_path: Path) -> None:
    block = run(5)
    older = recfunctions.rename_fields(block.step, {"not_converged": "unsolved"})
    trace = open_trace(write(tmp_path / "run.mcap", [block._replace(step=older)]))
    assert "unsolved" not in (trace.step.dtype.names or ())
    assert np.array_equal(trace.step["not_converged"], block.step["not_converged"])
