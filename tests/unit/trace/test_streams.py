"""Streams of a log: as many bytes as are counted of each step, and words where they belong."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from sample import BODIES, moving, run

from lavendersim.clock import Clock
from lavendersim.trace.blocks import Counted, counted
from lavendersim.trace.encode import encoders
from lavendersim.trace.layout import CHANNELS
from lavendersim.trace.schema import LOG10_RESIDUAL_FLOOR
from lavendersim.trace.streams import Chunk, ContactColumns, Points, Poses

BLOCK = run(40)
COLUMNS = BLOCK.step.dtype, BLOCK.contact.dtype, BLOCK.residual.dtype
TOPICS = frozenset(CHANNELS) - {"/velocities"}
THIRD = np.arange(40) % 3 == 0
PROLOGUE = b"prologue"


def count(posed=None, touched=None) -> Counted:
    every = np.ones(40, bool)
    return counted(BLOCK, every if posed is None else posed, every if touched is None else touched)


@pytest.mark.parametrize("name", ["points", "poses", "light"])
@pytest.mark.parametrize("cuts", [(0, 40), (0, 1, 17, 40)])
def test_a_chunk_has_the_bytes_that_are_counted_however_it_is_cut(
    name: str, cuts: tuple[int, ...]
) -> None:
    encoder = getattr(encoders(BODIES, COLUMNS, TOPICS), name)
    one = count(THIRD, THIRD)
    size = int(encoder.sizes(one).sum())
    parts = [encoder.part(one, low, high) for low, high in itertools.pairwise(cuts)]
    data = bytes(encoder.encode(PROLOGUE, parts, size)[0])  # the next fills the same memory
    whole = bytes(encoder.encode(PROLOGUE, [encoder.part(one, 0, 40)], size)[0])
    assert data == whole
    assert len(data) == len(PROLOGUE) + size
    assert data.startswith(PROLOGUE)


def test_what_is_not_recorded_takes_no_byte() -> None:
    streams = encoders(BODIES, COLUMNS, TOPICS)
    one = count(THIRD, THIRD)
    for encoder in (streams.poses, streams.points, streams.columns):
        assert not encoder.sizes(one)[~THIRD].any()
        assert (encoder.sizes(one)[THIRD] > 0).all()
    assert len(set(streams.poses.sizes(count()).tolist())) == 1  # of every step the same


def test_doubles_of_poses_stand_in_the_order_of_the_message() -> None:
    """x y z and then qx qy qz qw, the last behind them: protobuf's Vector3 and Quaternion."""
    poses = Poses(BODIES)
    one = count()
    data, ((channel, entries),) = poses.encode(b"", [poses.part(one, 0, 40)], int(poses.sizes(one).sum()))  # noqa: E501  # fmt: skip
    assert channel == CHANNELS["/tf"]
    size = int(poses.sizes(one)[0])
    assert entries["offset"].tolist() == [k * size for k in range(40)]
    assert entries["time"].tolist() == BLOCK.step["time_ns"].tolist()
    message = bytes(data)[5 * size : 6 * size]
    at = -1
    for number in BLOCK.pose[5][:, [0, 1, 2, 4, 5, 6, 3]].ravel():
        at = message.find(np.float64(number).tobytes(), at + 1)
        assert at > 0


def test_a_residual_of_zero_is_drawn_at_the_floor() -> None:
    block = BLOCK._replace(step=BLOCK.step.copy())
    block.step["residual"] = 1e-3
    block.step["residual"][7] = 0.0
    every = np.ones(40, bool)
    one = counted(block, every, every)
    light = encoders(BODIES, COLUMNS, TOPICS).light
    data, groups = light.encode(b"", [light.part(one, 0, 40)], int(light.sizes(one).sum()))
    entries = dict(groups)[CHANNELS["/plot/log10_residual"]]
    drawn = [
        np.frombuffer(bytes(data), "<f8", 1, int(at) + 9 + 22 + 20)[0]
        for at in entries["offset"]  # behind record, message and the head of the array
    ]
    assert drawn[7] == LOG10_RESIDUAL_FLOOR
    assert drawn[:7] == [math.log10(1e-3)] * 7


def test_a_scene_shares_its_encoders_and_keeps_its_own_numbers() -> None:
    points = Points(BODIES, COLUMNS[1])
    other = points.on_grid(0.5)
    assert (points._grid, other._grid) == (0.0, 0.5)
    assert other.form is points.form
    columns = ContactColumns(COLUMNS[1])
    clock = Clock(Fraction(1, 100))
    expecting = columns.expecting(clock, 0.25, None)
    assert (columns._slop, expecting._slop, expecting._clock) == (0.0, 0.25, clock)


def test_all_contacts_of_a_chunk_are_one_message() -> None:
    block = moving(40)
    every = np.ones(40, bool)
    one = counted(block, every, every)
    columns = ContactColumns(block.contact.dtype)
    columns = columns.expecting(Clock(Fraction(1, 240)), 0.0, None)
    # 4 contacts a step, each a word of every stored column; three words for the step itself
    assert set(columns.sizes(one).tolist()) == {8 * (3 + 4 * len(columns.form.names))}
    parts = [columns.part(one, 0, 13), columns.part(one, 13, 40)]
    laid, ((channel, entries),) = columns.encode(PROLOGUE, parts, 0)
    data = bytes(laid)  # the next fills the same memory
    assert (channel, entries["offset"].tolist()) == (CHANNELS["/contact_columns"], [len(PROLOGUE)])
    whole, _ = columns.encode(PROLOGUE, [columns.part(one, 0, 40)], 0)
    assert data == bytes(whole)


def test_a_chunk_that_is_not_full_is_no_chunk() -> None:
    with pytest.raises(AssertionError, match="other bytes than were counted"):
        Chunk(b"", 3).filled()
