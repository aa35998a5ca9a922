"""The tables of a log are what its reader gives, to the bit, and take the memory of a part."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet

from lavendersim import open_trace
from lavendersim.errors import UsageError
from lavendersim.trace.schema import CONTACT_COLUMNS
from tests.unit.trace import sample

# Peak memory [B] of Python, numpy and Arrow together, while the contacts of a log are exported.
PEAK = """
import sys, tracemalloc
from pathlib import Path
import pyarrow.parquet
from lavendersim import open_trace
from lavendersim.arrow.files import write_tables
tracemalloc.start()
table = open_trace(sys.argv[1]).table("contact")
write_tables([table], "parquet", Path(sys.argv[2]))
print(tracemalloc.get_traced_memory()[1] + pyarrow.default_memory_pool().max_memory())
"""


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return sample.write(tmp_path_factory.mktemp("log") / "made.mcap", [sample.run(900)])


def same(column: pa.ChunkedArray, expected: np.ndarray) -> bool:
    return bool(column.to_numpy().tobytes() == np.ascontiguousarray(expected).tobytes())


def test_steps_are_those_of_the_reader(log: Path) -> None:
    trace = open_trace(log)
    found, step = pa.table(trace.table("step")), trace.step
    assert found.column_names == list(step.dtype.names)
    assert [name for name in found.column_names if not same(found[name], step[name])] == []
    assert found.schema.field("residual").metadata[b"unit"] == b"m/s"


def test_contacts_are_those_of_the_reader(log: Path) -> None:
    """The sample's bodies are any integers: names are looked at below."""
    trace = open_trace(log)
    found, contact = pa.table(trace.table("contact")), trace.contact
    numbers = [name for name in found.column_names if name not in ("body_a", "body_b")]
    assert [name for name in numbers if not same(found[name], contact[name])] == []
    assert found.schema.field("feature").type == pa.int64()
    known = [name for name in numbers if name in CONTACT_COLUMNS]
    assert all(found.schema.field(name).metadata[b"meaning"] for name in known)


def test_bodies_of_contacts_are_names(tmp_path: Path) -> None:
    log = sample.write(tmp_path / "moving.mcap", [sample.moving(50)])
    found = pa.table(open_trace(log).table("contact"))
    assert set(found["body_a"].to_pylist()) == {"floor"}
    assert set(found["body_b"].to_pylist()) == {"ball"}


def test_poses_have_a_row_for_every_body(log: Path) -> None:
    trace = open_trace(log)
    found = pa.table(trace.table("pose"))
    assert found["body"].to_pylist()[:4] == [*sample.BODIES, sample.BODIES[0]]
    for k, name in enumerate(("x", "y", "z", "qw", "qx", "qy", "qz")):
        assert same(found[name], trace.pose[:, :, k].ravel())
    times = np.repeat(trace.step["step"], len(sample.BODIES)) * float(sample.TIMESTEP)
    np.testing.assert_allclose(found["time"].to_numpy(), times, atol=1e-9)  # a log counts ns


def test_a_log_without_contacts_says_why(tmp_path: Path) -> None:
    bare = sample.without(sample.run(9), "/contacts")
    log = sample.write(tmp_path / "bare.mcap", [bare], absent={"/contacts": "nothing touches"})
    with pytest.raises(UsageError, match="nothing touches"):
        open_trace(log).table("contact")


def test_an_unknown_table_is_refused_with_those_there_are(log: Path) -> None:
    with pytest.raises(UsageError, match="one of step, pose, velocity, contact"):
        open_trace(log).table("contacts")


def test_memory_does_not_grow_with_the_log(tmp_path: Path) -> None:
    """Both logs fill several row groups and chunks; of a row that comes a tenth may stay at most.

    The larger has 60,000 steps more with four contacts each: some 65 MB of rows.
    """
    peaks, sizes = [], []
    for steps in (40_000, 100_000):
        log = sample.write(tmp_path / f"{steps}.mcap", [sample.run(steps, contacts=8)])
        done = subprocess.run(
            [sys.executable, "-c", PEAK, log, tmp_path / str(steps)],
            capture_output=True,
            text=True,
            check=True,
        )
        peaks.append(int(done.stdout))
        rows = parquet.ParquetFile(tmp_path / str(steps) / "contact.parquet").metadata
        sizes.append(rows.num_rows * rows.num_columns * 8)
    assert sizes[1] - sizes[0] > 40e6
    assert peaks[1] - peaks[0] < 0.1 * (sizes[1] - sizes[0]), (peaks, sizes)
