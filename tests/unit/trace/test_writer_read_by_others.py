"""The log as others read it: the mcap package and google.protobuf, message by message."""

from __future__ import annotations

import math
import struct
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from logs_of_samples import messages
from mcap.reader import NonSeekingReader, make_reader
from sample import BODIES, CONFIG, TIMESTEP, moving, rolling, run, write

from lavendersim.trace import Block

STEPS = 400
KINDS = {5: "<u4", 6: "<i4", 7: "<f4", 8: "<f8", 1: "u1"}
# Points show positions to half of a grid, 2^-13 m: the power of two below 1/1024 of the 0.2 m that
# the ball is thick, as the crate; then a float32 rounds to 2^-24 of the number. Of the others it
# keeps nine bits behind the first: cutting takes less than 2^-9, and rounding before it 2^-24.
GRID, ROUNDED, CUT = 2.0**-13, 2.0**-24, 2.0**-9 + 2.0**-24
SHOWN = {
    **dict.fromkeys(("x", "y", "z"), (ROUNDED, GRID / 2)),
    **dict.fromkeys(("nx", "ny", "nz", "force_n", "penetration"), (CUT, 0.0)),
}
BULK = ("/tf", "/contacts", "/contact_columns")  # each in chunks of its own
SLOP = CONFIG.numerics.slop
LOADED = (213, 94, 0, 255)  # vermilion: the contact carries an impulse


@pytest.fixture(scope="module", params=["noise", "motion", "spheres"])
def block(request: pytest.FixtureRequest) -> Block:
    return {"noise": run, "motion": moving, "spheres": rolling}[request.param](STEPS)


@pytest.fixture(scope="module")
def path(block: Block, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(tmp_path_factory.mktemp("log") / "run.mcap", [block])


def same(a: float, b: float) -> bool:
    return struct.pack("<d", a) == struct.pack("<d", b)


def test_steps(path: Path, block: Block) -> None:
    found = list(messages(path, "/step"))
    assert len(found) == STEPS
    for row, (message, step) in zip(block.step, found, strict=True):
        assert (message.sequence, message.log_time) == (row["step"], row["time_ns"])
        assert message.publish_time == message.log_time
        for name in block.step.dtype.names or ():
            value = getattr(step, name)
            assert same(value, row[name]) if isinstance(value, float) else value == row[name]


def test_transforms(path: Path, block: Block) -> None:
    found = list(messages(path, "/tf"))
    assert len(found) == STEPS
    for row, poses, (_, message) in zip(block.step, block.pose, found, strict=True):
        assert [t.child_frame_id for t in message.transforms] == BODIES
        for pose, transform in zip(poses, message.transforms, strict=True):
            p, q = transform.translation, transform.rotation
            values = (p.x, p.y, p.z, q.w, q.x, q.y, q.z)
            assert all(same(a, b) for a, b in zip(values, pose, strict=True))
            assert transform.timestamp.ToNanoseconds() == row["time_ns"]
            assert transform.parent_frame_id == "world"


def test_points(path: Path, block: Block) -> None:
    """What viewers see: every contact where it is, its normal, force and penetration."""
    found = list(messages(path, "/contacts"))
    assert len(found) == STEPS  # also where there are none, so that viewers clear
    for row, (_, cloud) in zip(block.step, found, strict=True):
        rows = block.contact[block.contact["step"] == row["step"]]
        assert cloud.timestamp.ToNanoseconds() == row["time_ns"]
        assert (cloud.frame_id, cloud.pose.orientation.w) == ("world", 1.0)
        names = [field.name for field in cloud.fields]
        assert names == [*SHOWN, "red", "green", "blue", "alpha"]
        assert len(cloud.data) == len(rows) * cloud.point_stride
        for field in cloud.fields:
            dtype = np.dtype(
                {
                    "names": ["v"],
                    "formats": [KINDS[field.type]],
                    "offsets": [field.offset],
                    "itemsize": cloud.point_stride,
                }
            )
            values = np.frombuffer(cloud.data, dtype)["v"]
            if field.name in SHOWN:
                true = rows[field.name]
                within = np.abs(true) > np.finfo(np.float32).tiny  # a float32 has all its digits
                pairs = values[within], true[within]
                relative, absolute = SHOWN[field.name]
                assert np.allclose(*pairs, rtol=relative, atol=absolute, equal_nan=True)
                if absolute:
                    grid = values[np.isfinite(values)] / GRID
                    assert np.array_equal(grid, np.rint(grid))
                assert np.all(values[true == 0.0] == 0.0)
            else:
                loaded = LOADED[names.index(field.name) - len(SHOWN)]
                assert ((values == loaded) | ~(rows["impulse_n"] > 0)).all()


def test_contact_columns(path: Path, block: Block) -> None:
    """Number by number, as docs/architecture.md has it: keys summed up, planes put together."""
    rows = iter(block.contact)
    seen: set[int] = set()
    poses = {m.sequence: [t.translation for t in tf.transforms] for m, tf in messages(path, "/tf")}
    for message, group in messages(path, "/contact_columns"):
        steps, times, counts = (
            np.frombuffer(one, "<i8").tolist() for one in (group.steps, group.times, group.counts)
        )
        assert (message.sequence, message.log_time) == (steps[0], times[0])
        bodies = list(struct.iter_unpack("<8d", group.bodies))
        of_step = [step for step, count in zip(steps, counts, strict=True) for _ in range(count)]
        count, names = len(of_step), list(group.names)
        known = [name for name in names if name in ("body_a", "body_b", "feature")]
        numbers = [name for name in names if name not in known]
        differences = np.frombuffer(group.keys, "<i8").reshape(len(known), count)
        keys = list(zip(*(np.cumsum(one).tolist() for one in differences), strict=True))
        order = sorted(range(count), key=lambda row: (keys[row], row))
        found: list[dict[str, int]] = [dict(zip(known, key, strict=True)) for key in keys]
        used = dict(zip(numbers, group.predictors, strict=True))
        constants = struct.unpack("<dd", group.constants)
        assert constants == (float(TIMESTEP), SLOP)
        # those of which others are expected come first
        when = {name: (code in (3, 4, 5, 6), code) for name, code in used.items()}
        for m, name in sorted(enumerate(numbers), key=lambda one: when[one[1]]):
            before: list[int] = []  # the numbers before of the same key
            last = None
            for place, row in enumerate(order):
                size = len(numbers) * count
                bits = int.from_bytes(group.planes[m * count + place :: size], "big")
                if last is None or keys[last] != keys[row]:
                    before, last = [], None
                others = found[row], {} if last is None else found[last]
                code = used[name]
                if code == 7:
                    places = poses.get(of_step[row] - 1) if of_step[row] > steps[0] else None
                    number_expected = on_floor(found[row], bodies, places).get(name)
                    code = 2 if number_expected is None else 7
                    others = {}, {} if number_expected is None else {"expected": number_expected}
                found[row][name] = number(code, bits, before, others)
                before.append(found[row][name])
                last = row
        seen.update(used.values())
        for step, one in zip(of_step, found, strict=True):
            row = next(rows)
            assert step == row["step"]
            for name, kind in zip(names, group.kinds, strict=True):
                if name in known:
                    assert one[name] == row[name]
                else:
                    assert kind == "f8"
                    assert one[name].to_bytes(8, "little") == row[name].tobytes()
    assert next(rows, None) is None
    if not np.isnan(block.contact["x"]).any():  # else this test says less than it should
        of_balls = {7} if block.contact["body_b"].max() == 2 else {3}
        assert seen == {0, 1, 2, 4, 5, 6} | of_balls


def number(
    predictor: int, stored: int, before: list[int], others: tuple[dict[str, int], dict[str, int]]
) -> int:
    """Return the bits of a number; before: those of its key; others: of this row and the last."""
    by_difference = (stored >> 1) ^ -(stored & 1)
    if predictor == 0:
        return stored ^ (before[-1] if before else 0)
    if predictor == 1:
        return ((before[-1] if before else 0) + by_difference) % 2**64
    if predictor == 2:
        rise = before[-1] - before[-2] if len(before) > 1 else 0
        return ((before[-1] if before else 0) + rise + by_difference) % 2**64
    if predictor == 7:
        return (others[1]["expected"] + by_difference) % 2**64
    if predictor == 4:
        return (others[1].get("normal_velocity", 0) + by_difference) % 2**64
    own = {
        name: struct.unpack("<d", bits.to_bytes(8, "little"))[0] for name, bits in others[0].items()
    }
    expected = {3: third_of_unit, 5: target_of_gap, 6: residual}[predictor](own)
    return stored ^ int.from_bytes(struct.pack("<d", expected), "little")


def on_floor(
    row: dict[str, int], bodies: list[tuple[float, ...]], places: list[Any] | None
) -> dict[str, int]:
    """Return the bits of the contact of a ball on a plane; nothing of other bodies.

    bodies: radius, normal, offset, and position at the start of the first step; places: positions
    at the start of this one, where it is another.
    """
    plane, ball = bodies[row["body_a"]], bodies[row["body_b"]]
    if ball[0] == 0.0:
        return {}
    normal, radius = plane[1:4], ball[0]
    at = ball[5:] if places is None else [getattr(places[row["body_b"]], axis) for axis in "xyz"]
    gap = normal[0] * at[0] + normal[1] * at[1] + normal[2] * at[2] - plane[4] - radius
    reach = radius + 0.5 * gap
    point = [x - n * reach for x, n in zip(at, normal, strict=True)]
    names = ("x", "y", "z", "nx", "ny", "nz", "separation")
    numbers = zip(names, [*point, *normal, gap], strict=True)
    return {n: int.from_bytes(struct.pack("<d", one), "little") for n, one in numbers}


def third_of_unit(row: dict[str, float]) -> float:
    left = 1.0 - row["nx"] * row["nx"] - row["ny"] * row["ny"]
    return math.sqrt(left if left >= 0.0 else 0.0)


def target_of_gap(row: dict[str, float]) -> float:
    gap = row["separation"] - SLOP
    return gap / float(TIMESTEP) if gap > 0.0 else 0.0


def residual(row: dict[str, float]) -> float:
    k_n, impulse = row["inverse_effective_mass"], row["impulse_n"]
    normal = abs(min(row["normal_velocity"] + row["target"], impulse / (1.0 / k_n)))
    k_t = 3.5 * k_n
    scaled = [k_t * row["impulse_t1"], k_t * row["impulse_t2"]]
    moved = [scaled[0] - row["slip_t1"], scaled[1] - row["slip_t2"]]
    limit, squared = k_t * row["friction"] * impulse, moved[0] * moved[0] + moved[1] * moved[1]
    if squared > limit * limit:
        scale = limit / math.sqrt(squared)
        moved = [moved[0] * scale, moved[1] * scale]
    off = [moved[0] - scaled[0], moved[1] - scaled[1]]
    return max(normal, math.sqrt(off[0] * off[0] + off[1] * off[1]))


def test_residuals(path: Path, block: Block) -> None:
    rows = iter(block.residual)
    for message, residuals in messages(path, "/residuals"):
        assert residuals.step == message.sequence
        for sweep in residuals.sweeps:
            row = next(rows)
            assert (residuals.step, sweep.sweep) == (row["step"], row["sweep"])
            assert same(sweep.residual, row["residual"])
    assert next(rows, None) is None


def test_plots_are_cdr_and_log10_of_zero_is_the_floor(path: Path, block: Block) -> None:
    values = {}
    with path.open("rb") as stream:
        for _, channel, message in make_reader(stream, validate_crcs=True).iter_messages():
            if channel.topic.startswith("/plot/"):
                head = (b"\0\1\0\0", 0, 0, 1, 0)  # little endian; no dimensions; one value
                assert struct.unpack("<4sIIII", message.data[:20]) == head
                values.setdefault(channel.topic, []).append(*struct.unpack("<d", message.data[20:]))
    assert np.array_equal(values["/plot/force"], block.step["total_normal_force"], equal_nan=True)
    drawn = np.array(values["/plot/log10_residual"])
    assert np.all(drawn[block.step["residual"] == 0.0] == -18.0)
    usual = block.step["residual"] > 1e-15
    assert np.array_equal(drawn[usual], np.log10(block.step["residual"][usual]))


def test_the_geometry_has_a_link_for_every_body(path: Path) -> None:
    with path.open("rb") as stream:
        ((_, _, message),) = make_reader(stream).iter_messages(topics=["/robot_description"])
    (length,) = struct.unpack_from("<I", message.data, 4)
    assert len(message.data) == 8 + length
    robot = ET.fromstring(message.data[8:-1])
    assert [
        link.get("name") for link in robot.iter("link") if link.find("visual") is not None
    ] == BODIES


def test_a_reader_that_cannot_seek_sees_the_same_messages(path: Path) -> None:
    with path.open("rb") as stream:
        seeking = [m for _, _, m in make_reader(stream, validate_crcs=True).iter_messages()]
    with path.open("rb") as stream:
        other = [m for _, _, m in NonSeekingReader(stream, validate_crcs=True).iter_messages()]
    key = lambda m: (m.log_time, m.channel_id)  # noqa: E731
    assert sorted(seeking, key=key) == sorted(other, key=key)


def test_messages_of_a_chunk_stand_in_order_of_time(path: Path) -> None:
    with path.open("rb") as stream:
        last: dict[str, int] = {}
        for _, channel, message in NonSeekingReader(stream).iter_messages(log_time_order=False):
            stream = channel.topic if channel.topic in BULK else "light"
            assert message.log_time >= last.get(stream, 0)
            last[stream] = message.log_time
