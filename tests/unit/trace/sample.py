"""A made-up run for the tests of the log: blocks of random but fixed numbers, without an engine."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.trace import Block, TraceWriter
from lavendersim.trace.contact_columns import DERIVED
from lavendersim.trace.schema import CONTACT_COLUMNS, STEP_COLUMNS
from tests.made_cells import made_cell

BODIES = ["floor", "ball", "crate"]
TIMESTEP = Fraction(1, 240)
AS_WRITTEN = "question: does it bounce? # é\n"
SCENE: dict[str, Any] = {
    "floor": {"shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}},
    "ball": {"shape": {"kind": "sphere", "radius": 0.1}},
    "crate": {"shape": {"kind": "box", "size": [0.2, 0.3, 0.4]}, "mass": 2e-07},
}
CONFIG = made_cell(SCENE, numerics={"slop": 1e-09})
METADATA = {"versions": {"numpy": "2", "engine": "abc"}, "plan": {"digest": "77"}}
INTEGERS = ("step", "body_a", "body_b", "feature")


def run(steps: int, seed: int = 0, extra: tuple[str, ...] = (), contacts: int = 4) -> Block:
    """Return a whole run as one block: 0..contacts contacts a step, residuals on some."""
    random = np.random.default_rng(seed)
    step = np.zeros(steps, [(c.name, c.kind) for c in STEP_COLUMNS])
    for column in STEP_COLUMNS:
        step[column.name] = _noise(random, steps, column.kind)
    step["step"] = np.arange(steps)
    step["time_ns"] = np.arange(steps) * 10**9 // 240
    step["residual"] = np.abs(step["residual"])
    counts = random.integers(0, contacts + 1, steps)
    counts[0] = 0
    names = ["step", "body_a", "body_b", "feature", *CONTACT_COLUMNS, *extra]
    fields = [(n, "i8" if n in INTEGERS else "f8") for n in dict.fromkeys(names)]
    contact = np.zeros(counts.sum(), fields)
    for name, kind in fields:
        contact[name] = _noise(random, len(contact), kind)
    contact["step"] = np.repeat(step["step"], counts)
    follow(contact, np.full(len(contact), float(TIMESTEP)))
    asked = np.flatnonzero(random.random(steps) < 0.3)
    residual = np.zeros(len(asked) * 5, [("step", "i8"), ("sweep", "i8"), ("residual", "f8")])
    residual["step"] = np.repeat(asked, 5)
    residual["sweep"] = np.tile(np.arange(5), len(asked))
    residual["residual"] = _noise(random, len(residual), "f8")
    pose = _noise(random, steps * len(BODIES) * 7, "f8").reshape(steps, len(BODIES), 7)
    pose[0] = [0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0]  # a scene is built from finite poses
    return Block(step, contact, pose, residual)


def moving(steps: int) -> Block:
    """Return a run whose contacts persist: four on each step, which move, turn and slow down."""
    block = run(steps)
    number = np.repeat(np.arange(steps), 4)
    rows = np.zeros(4 * steps, block.contact.dtype)
    rows["step"], rows["body_b"], rows["feature"] = number, 1, np.tile(np.arange(4), steps)
    random = np.random.default_rng(1)
    rows["x"] = 1.0 + rows["feature"] + 0.001 * number  # a straight line within each power of two
    turned = 0.3 + 0.002 * number + rows["feature"]
    rows["nx"], rows["ny"] = 0.8 * np.cos(turned), 0.8 * np.sin(turned)
    rows["nz"] = np.sqrt(1.0 - rows["nx"] ** 2 - rows["ny"] ** 2)
    rows["y"] = 3.0 + 1e-6 * random.normal(size=len(rows))
    rows["normal_velocity"] = random.normal(size=len(rows))
    slop = CONFIG.numerics.slop
    rows["separation"] = slop + 1e-6 * random.normal(size=len(rows))
    rows["target"] = _target(rows["separation"])
    rows["inverse_effective_mass"], rows["friction"] = 2.0, 0.5
    rows["impulse_n"] = np.abs(random.normal(size=len(rows)))
    for name in ("impulse_t1", "impulse_t2", "slip_t1", "slip_t2"):
        rows[name] = 0.2 * random.normal(size=len(rows))
    rows["residual"] = _natural_map(rows)
    rows["approach_velocity"][4:] = rows["normal_velocity"][:-4] * (1.0 - 1e-9)
    follow(rows, np.full(len(rows), float(TIMESTEP)))
    return block._replace(contact=rows)


def rolling(steps: int) -> Block:
    """Return a run in which a ball rolls over the floor: two contacts of it, and one of the crate.

    Where the ball is at the start of a step follows from its pose after the one before.
    """
    block = moving(steps)
    random = np.random.default_rng(2)
    pose = np.zeros((steps, len(BODIES), 7))
    pose[:, :, :3] = np.cumsum(random.normal(size=(steps, len(BODIES), 3)), axis=0)
    rows = block.contact[block.contact["feature"] < 3].copy()
    rows["body_b"] = 1 + (rows["feature"] == 2)
    of_ball = rows["body_b"] == 1
    x, y, z = (pose[np.maximum(rows["step"] - 1, 0), 1, axis] for axis in range(3))
    separation = z - 0.1  # its radius; the floor is z = 0
    where = {"x": x, "y": y, "z": z - (0.1 + 0.5 * separation), "nx": 0.0, "ny": 0.0, "nz": 1.0}
    for name, numbers in {**where, "separation": separation}.items():
        rows[name] = np.where(of_ball, numbers, rows[name])
    rows["target"] = _target(rows["separation"])
    follow(rows, np.full(len(rows), float(TIMESTEP)))
    return block._replace(contact=rows, pose=pose)


def _target(separation: Any) -> Any:
    """Return what rows ask for that close a gap beyond the slop within the timestep [m/s]."""
    gap = separation - CONFIG.numerics.slop
    return np.where(gap > 0.0, gap / float(TIMESTEP), 0.0)


def _natural_map(rows: Any) -> Any:
    """Return the residual of rows [m/s], of balls; by vectors, not as an engine rounds it."""
    k_n = rows["inverse_effective_mass"]
    normal = np.minimum(rows["normal_velocity"] + rows["target"], k_n * rows["impulse_n"])
    scaled = 3.5 * k_n * np.stack([rows["impulse_t1"], rows["impulse_t2"]])
    moved = scaled - np.stack([rows["slip_t1"], rows["slip_t2"]])
    limit, length = 3.5 * k_n * rows["friction"] * rows["impulse_n"], np.hypot(*moved)
    off = moved * np.minimum(limit / length, 1.0) - scaled
    return np.maximum(np.abs(normal), np.hypot(*off))


def follow(contact: Any, timesteps: Any) -> None:
    """Give the columns that follow from others the values by which they do, as an engine has them.

    timesteps: [s] of each row.
    """
    with np.errstate(all="ignore"):
        for name, derived in DERIVED.items():
            contact[name] = derived.value(contact, timesteps)


def _noise(random: np.random.Generator, count: int, kind: str) -> Any:
    """Return any bit pattern for integers; for floats also zero, the infinities and subnormals."""
    if kind != "f8":
        return random.integers(-(2**63), 2**63 - 1, count, np.int64).view(kind)
    special = np.array([0.0, -0.0, np.inf, 5e-324, 1.0, np.nan])
    return np.where(
        random.random(count) < 0.1, random.choice(special, count), random.normal(size=count)
    )


def split(block: Block, sizes: list[int]) -> list[Block]:
    """Return the same run in blocks of the given sizes; the last takes the rest."""
    cuts = [0, *np.cumsum(sizes).tolist(), len(block.step)]
    blocks = []
    for low, high in itertools.pairwise(cuts):
        steps = block.step[low:high]
        inside = [np.isin(rows["step"], steps["step"]) for rows in (block.contact, block.residual)]
        parts = (block.contact[inside[0]], block.pose[low:high], block.residual[inside[1]])
        blocks.append(Block(steps, *parts))
    return blocks


def without(block: Block, *topics: str) -> Block:
    """Return the run as an engine gives it that logs no rows for these topics."""
    contact = block.contact[:0] if "/contacts" in topics else block.contact
    residual = block.residual[:0] if "/residuals" in topics else block.residual
    return block._replace(contact=contact, residual=residual)


def write(
    path: Path,
    blocks: list[Block],
    status: str | None = "complete",
    absent: Mapping[str, str] | None = None,
    config: CellConfig = CONFIG,
) -> Path:
    """Write blocks as a log; status None leaves it as a killed run would."""
    writer = TraceWriter(path, config, AS_WRITTEN, METADATA, absent)
    for block in blocks:
        writer.append(block)
    if status is None:
        writer.abandon()
    else:
        writer.close(status)
    return path
