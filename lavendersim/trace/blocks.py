"""Blocks of steps as they come in, and how many rows of each kind every step has."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.trace.wire import Rows


class Block(NamedTuple):
    """Many steps of a run, as numpy arrays; the columns are listed in `schema`.

    step: structured (n,). contact: structured, rows grouped by `step` ascending. pose: (n, bodies,
    7), x y z [m] and qw qx qy qz; (n, bodies, 13) with vx vy vz [m/s] and wx wy wz [rad/s] behind
    them, for a log of velocities. residual: structured `step`, `sweep`, `residual`; may be empty.
    """

    step: NDArray[Any]
    contact: NDArray[Any]
    pose: NDArray[np.float64]
    residual: NDArray[Any]


class Counted(NamedTuple):
    """A block with what its log records of each step; n steps."""

    block: Block
    posed: Rows  # whether poses are recorded, (n,)
    touched: Rows  # whether contacts are, (n,)
    contact_start: NDArray[np.int64]  # where the rows of each step begin, (n + 1,)
    residual_start: NDArray[np.int64]
    before: NDArray[np.float64] | None = None  # poses of the state before, (bodies, 7)


def counted(block: Block, posed: Rows, touched: Rows) -> Counted:
    """Return a block with its counts. ValueError when it contradicts itself."""
    steps = block.step["step"]
    return Counted(
        block,
        posed,
        touched,
        _starts(steps, block.contact["step"], "contacts"),
        _starts(steps, block.residual["step"], "residuals"),
    )


def _starts(steps: Rows, owners: Rows, what: str) -> NDArray[np.int64]:
    """Return where the rows of each step begin. ValueError when out of order, or strays."""
    starts = np.zeros(len(steps) + 1, np.int64)
    if not len(owners):
        return starts
    owners = np.ascontiguousarray(owners)  # of every row one number, read more than once
    starts[1:] = owners.searchsorted(steps, "right")
    # Of owners in another order the counts may be below 0, or of other steps.
    counts = starts[1:] - starts[:-1]
    ordered = starts[-1] == len(owners) and counts.min() >= 0
    if not (ordered and (steps.repeat(counts) == owners).all()):
        raise ValueError(f"{what} of a block are not grouped by its steps")
    return starts


def cumulative(sizes: Rows) -> NDArray[np.int64]:
    """Return where each of these begins, and where the last ends (n + 1,)."""
    starts = np.zeros(len(sizes) + 1, np.int64)
    sizes.cumsum(out=starts[1:])
    return starts
