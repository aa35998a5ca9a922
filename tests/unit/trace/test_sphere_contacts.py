"""Contacts of spheres cost nothing where poses give them, and come back bit for bit in any case."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sample import rolling, split, write

from lavendersim.cell.shapes import Plane, Sphere
from lavendersim.errors import TraceError
from lavendersim.experiment import load_experiment_text
from lavendersim.runner import run
from lavendersim.trace import Block, TraceWriter, decode, open_trace
from lavendersim.trace.contact_columns import Packed, pack, unpack
from lavendersim.trace.positions import Positions
from lavendersim.trace.predictors import SPHERES, Constants
from lavendersim.trace.sphere_contacts import (
    COLUMNS,
    FIELDS,
    POSITION,
    Starts,
    body_table,
    expected_contacts,
)

# A pile of balls at a wall, a box that falls beside them, one ball that is moved, and a timestep
# that changes. A ball that rolls has contacts at the middle of a step: of it less is expected.
SCENE = """\
scene:
  surfaces: {held: {friction: 0.5}}
  bodies:
    floor: {shape: {kind: plane, normal: [0, 0, 2]}, surface: held}
    west: {shape: {kind: plane, normal: [1, 0, 0], offset: -0.3}, surface: held}
    box: {shape: {kind: box, size: [0.2, 0.2, 0.2]}, mass: 1.0, position: [0.6, 0, 1.6]}
    low: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, surface: held, position: [-0.2, 0, 0.1]}
    high: {shape: {kind: sphere, radius: 0.07}, mass: 2.0, surface: held, position: [-0.2, 0, 0.28]}
    top: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, surface: held, position: [0.1, 0, 0.12]}
events:
  - {at: 0.4, body: top, teleport: [0.1, 0.3, 0.2]}
  - {at: 0.5, timestep: 1/777}
duration: 0.8
"""
NAMES = ("body_a", "body_b", "feature", *COLUMNS, "impulse_n")
TABLE = np.zeros((4, FIELDS))
TABLE[0, 1:5] = 0.0, 0.6, 0.8, -0.25  # a plane
TABLE[1:3, 0] = 0.5, 0.25  # two spheres; the fourth is neither


def of_spheres(path: Path) -> set[str]:
    """Return the columns of a log whose numbers are expected by where spheres are."""
    log = open_trace(path)
    schema = log._source.schema(9)
    assert schema is not None
    found = set()
    for chunk in log._source.chunks(9):
        message: Any = decode.message_class(schema.name, schema.data)()
        message.ParseFromString(decode.body_of(chunk, int(chunk.messages[9]["offset"][0])))
        names = [name for name in message.names if name not in NAMES[:3]]
        pairs = zip(names, message.predictors, strict=True)
        found |= {name for name, code in pairs if code == SPHERES}
    return found


def test_every_bit_of_a_run_of_spheres_returns(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    blocks: list[Block] = []
    append = TraceWriter.append

    def noted(self: TraceWriter, block: Block) -> None:
        blocks.append(block)
        append(self, block)

    monkeypatch.setattr(TraceWriter, "append", noted)
    path = run(load_experiment_text(SCENE, "scene.yaml"), tmp_path).run.cells[0].path
    rows = np.concatenate([block.contact for block in blocks])
    assert {"separation"} <= of_spheres(path) <= {*COLUMNS}
    log = open_trace(path)
    assert len(log.contact) == len(rows) > 500
    for name in rows.dtype.names or ():
        assert log.contact[name].tobytes() == rows[name].tobytes(), name


def test_contacts_are_read_before_and_after_poses(tmp_path: Path) -> None:
    block = rolling(300)
    first, second = (open_trace(write(tmp_path / "run.mcap", [block])) for _ in range(2))
    assert len(first.pose) == 300
    for log in (first, second):
        for name in ("x", "z", "separation", "impulse_n"):
            assert log.contact[name].tobytes() == block.contact[name].tobytes()


@pytest.mark.parametrize("sizes", [[1, 1, 1], [7, 100], [299]])
def test_a_log_of_spheres_has_the_same_bytes_for_any_split(
    tmp_path: Path, sizes: list[int]
) -> None:
    block = rolling(300)
    whole = write(tmp_path / "whole.mcap", [block]).read_bytes()
    assert write(tmp_path / "parts.mcap", split(block, sizes)).read_bytes() == whole


def test_two_spheres_and_a_sphere_on_a_plane_are_as_geometry_has_them() -> None:
    """A 3-4-5 triangle: centres 0.625 apart, 0.125 of which is gap; all numbers are exact."""
    positions = np.zeros((1, 4, 3))
    positions[0, 1:3] = (1.0, 1.0, 1.0), (1.0 + 0.525, 1.0, 1.0 + 0.7)
    found = expected_contacts(
        np.array([1, 0, 0, 1, -1]),
        np.array([2, 1, 3, 0, 9]),
        Starts(TABLE, positions, np.zeros(5, np.intp)),
    )
    assert found.known.tolist() == [True, True, False, False, False]
    pair = {name: column[0] for name, column in found.columns.items()}
    # each is the result of at most ten roundings of numbers below 2
    near = {"abs": 10 * 2.0**-52}
    assert pair["separation"] == pytest.approx(0.875 - 0.75, **near)
    assert [pair[n] for n in ("nx", "ny", "nz")] == pytest.approx([0.6, 0.0, 0.8], **near)
    # the middle of the gap: 0.5 + 0.0625 from the first centre
    point = [1.0 + 0.6 * 0.5625, 1.0, 1.0 + 0.8 * 0.5625]
    assert [pair[n] for n in "xyz"] == pytest.approx(point, **near)
    plane = {name: column[1] for name, column in found.columns.items()}
    assert plane["separation"] == pytest.approx(0.6 + 0.8 + 0.25 - 0.5, **near)
    assert [plane[n] for n in ("nx", "ny", "nz")] == [0.0, 0.6, 0.8]
    depth = 0.5 + 0.5 * plane["separation"]
    assert [plane[n] for n in "xyz"] == pytest.approx(
        [1.0, 1.0 - 0.6 * depth, 1.0 - 0.8 * depth], **near
    )


def made(seed: int, share: float, count: int = 400) -> tuple[np.ndarray, Starts]:
    """Return contacts that come and go, of which a share is as expected, the others any bits."""
    random = np.random.default_rng(seed)
    special = [np.nan, -np.nan, np.inf, -np.inf, -0.0, 5e-324, 1e308]
    positions = random.normal(size=(20, 4, 3))
    positions[random.random(positions.shape) < 0.05] = random.choice(special)
    starts = Starts(TABLE, positions, np.sort(random.integers(0, 20, count)))
    rows = np.zeros(count, [(name, "i8" if name in NAMES[:3] else "f8") for name in NAMES])
    rows["body_a"], rows["body_b"] = random.integers(-1, 5, (2, count))
    expected = expected_contacts(rows["body_a"], rows["body_b"], starts)
    for name in NAMES[3:]:
        noise = random.integers(-(2**63), 2**63 - 1, count).view(np.float64)
        noise = np.where(random.random(count) < 0.1, random.choice(special, count), noise)
        as_expected = expected.known & (random.random(count) < share) & (name in COLUMNS)
        rows[name] = np.where(as_expected, expected.columns.get(name, noise), noise)
    return rows, starts


@pytest.mark.parametrize("known_only", [True, False])
@pytest.mark.parametrize("share", [1.0, 0.6, 0.0])
@pytest.mark.parametrize("seed", range(5))
def test_any_rows_return(seed: int, share: float, known_only: bool) -> None:
    rows, starts = made(seed, share)
    if known_only:
        mine = expected_contacts(rows["body_a"], rows["body_b"], starts).known
        rows, starts = rows[mine], starts._replace(step=starts.step[mine])
    packed = pack([rows], NAMES, Constants(), starts)
    assert (SPHERES in packed.predictors) == (known_only and share > 0.5)
    table = np.zeros(len(rows), rows.dtype)

    def given(bodies: np.ndarray) -> Starts:
        """Return the starts by the bodies of the log, which have their first position alone."""
        assert bodies[:, :5].tobytes() == TABLE[:, :5].tobytes()
        assert bodies[:, POSITION].tobytes() == starts.positions[0].tobytes()
        return starts._replace(bodies=bodies)

    unpack(packed, NAMES, table, given)
    assert table.tobytes() == rows.tobytes()


def test_what_is_expected_costs_no_byte() -> None:
    rows, starts = made(1, 1.0)
    mine = expected_contacts(rows["body_a"], rows["body_b"], starts).known
    rows, starts = rows[mine], starts._replace(step=starts.step[mine])
    packed = pack([rows], NAMES, Constants(), starts)
    planes = np.frombuffer(packed.planes, np.uint8).reshape(8, len(NAMES) - 3, len(rows))
    assert not planes[:, : len(COLUMNS)].any()


def test_no_number_that_is_expected_is_nan() -> None:
    """NaN has many bit patterns, and machines differ in which one an operation gives."""
    positions = np.full((1, 4, 3), math.inf)
    found = expected_contacts(
        np.array([1]), np.array([2]), Starts(TABLE, positions, np.zeros(1, np.intp))
    )
    assert not any(np.isnan(column).any() for column in found.columns.values())


def test_predictors_without_the_bodies_that_they_need_are_refused() -> None:
    rows, starts = made(1, 1.0)
    mine = expected_contacts(rows["body_a"], rows["body_b"], starts).known
    rows, starts = rows[mine], starts._replace(step=starts.step[mine])
    packed: Packed = pack([rows], NAMES, Constants(), starts)
    with pytest.raises(ValueError, match="predictor 7, none of this version"):
        unpack(packed._replace(bodies=b""), NAMES, np.zeros_like(rows))
    with pytest.raises(ValueError, match="predictor 7 without bodies"):
        unpack(packed, NAMES, np.zeros_like(rows))


def test_a_log_has_bodies_only_where_one_is_a_sphere() -> None:
    plane = Plane(kind="plane", normal=(0.0, 3.0, 4.0), offset=-0.5)
    assert body_table([plane]) is None
    table = body_table([plane, Sphere(kind="sphere", radius=0.3)])
    assert table is not None
    assert table.tolist() == [[0.0, 0.0, 0.6, 0.8, -0.5, 0, 0, 0], [0.3, 0, 0, 0, 0, 0, 0, 0]]


def parts() -> list[tuple[np.ndarray, np.ndarray]]:
    poses = np.arange(10.0)[:, None, None] + np.zeros((10, 2, 7))
    return [(np.arange(4), poses[:4]), (np.arange(4, 10), poses[4:])]


def test_positions_come_over_the_ends_of_parts() -> None:
    positions = Positions(iter(parts()))
    for steps in ([0], [0, 1], [2, 3, 4, 5], [5], [6, 8, 9]):
        assert positions(np.array(steps))[:, 1, 2].tolist() == steps


@pytest.mark.parametrize("steps", [[10], [9, 10], [-1, 0]])
def test_positions_that_are_not_there_are_refused(steps: list[int]) -> None:
    with pytest.raises(ValueError, match=r"no poses of step -?\d+, by which contacts are expected"):
        Positions(iter(parts()))(np.array(steps))


def test_a_log_that_lost_its_poses_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log = open_trace(write(tmp_path / "run.mcap", [rolling(50)]))
    monkeypatch.setattr(type(log), "poses_in_parts", lambda self: iter(()))
    with pytest.raises(TraceError, match="no poses of step 0, by which contacts are expected"):
        _ = log.contact
