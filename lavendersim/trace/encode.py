"""The bytes of steps: whole MCAP Message records, in four streams of chunks.

    columns  | rows of contacts, for `/contact_columns`; a chunk makes one message of them
    points   | /contacts: head, point, point, ..              | next step ..
    poses    | /tf [/velocities]                              | next step ..
    light    | /step /plot.. [/residuals: head, row, row, ..] | next step ..

Of a block only sizes are counted as it comes in; a chunk keeps the rows of its steps as they stand
in memory, and lays them out when it closes, in any thread. A topic that the log does without takes
no byte; a stream without topics is empty.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any, Generic, NamedTuple, Protocol, TypeVar

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.cell.record import ALL
from lavendersim.cell.shapes.shape import Convex
from lavendersim.trace import layout
from lavendersim.trace.blocks import Block, Counted, counted
from lavendersim.trace.points import grid_of
from lavendersim.trace.sphere_contacts import body_table
from lavendersim.trace.streams import ContactColumns, Laid, Light, Points, Poses
from lavendersim.trace.wire import Rows

Kind = TypeVar("Kind")


class Streams(NamedTuple, Generic[Kind]):
    """One thing of each stream, in the order in which their chunks stand in the file."""

    columns: Kind
    points: Kind
    poses: Kind
    light: Kind


class Encoder(Protocol):
    """How one stream is laid out, fixed by a run's bodies, topics and columns; it has no state."""

    def sizes(self, counted: Counted) -> Rows:
        """Return the bytes of each step [B] (n,)."""

    def part(self, counted: Counted, first: int, last: int) -> Any:
        """Return what is needed of the steps first..last, rows as they stand in memory."""

    def encode(self, prologue: bytes, parts: Sequence[Any], size: int) -> Laid:
        """Return the bytes of a chunk: prologue, then `size` bytes of messages; and its index."""


def encoders(
    bodies: Sequence[str], columns: tuple[np.dtype[Any], ...], topics: Collection[str]
) -> Streams[Encoder]:
    """Return the encoders of a run; columns: of the tables step, contact and residual."""
    step, contact, residual = columns
    nothing = Nothing()
    touches = "/contacts" in topics
    return Streams(
        ContactColumns(contact) if touches else nothing,
        Points(bodies, contact) if touches else nothing,
        Poses(bodies, "/velocities" in topics) if "/tf" in topics else nothing,
        Light(step, residual, topics),
    )


def encoders_of_cell(shared: Streams[Encoder], config: CellConfig) -> Streams[Encoder]:
    """Return the encoders of one cell, from those that cells of equal bodies and columns share."""
    columns, points = shared.columns, shared.points
    if isinstance(columns, ContactColumns) and isinstance(points, Points):
        every_shape = [body.shape for body in config.scene.bodies.values()]
        grid = grid_of(shape.thickness() for shape in every_shape if isinstance(shape, Convex))
        record, posed = config.record, isinstance(shared.poses, Poses)
        every = posed and record.poses == record.contacts == ALL
        bodies = body_table(every_shape) if every else None
        columns = columns.expecting(config.clock, config.numerics.slop, bodies)
        return shared._replace(columns=columns, points=points.on_grid(grid))
    return shared


def checked(
    block: Block,
    posed: Rows,
    touched: Rows,
    columns: tuple[np.dtype[Any], ...],
    topics: Collection[str],
    bodies: int,
) -> Counted:
    """Return a block with its counts. ValueError when it contradicts itself or its log.

    posed, touched: whether poses and contacts of each step are recorded, bool (n,). columns: of
    the log's tables. topics: that it has. bodies: how many.
    """
    if (block.step.dtype, block.contact.dtype, block.residual.dtype) != columns:
        raise ValueError("a block has other columns than the first one")
    width = layout.POSE + (layout.VELOCITY if "/velocities" in topics else 0)
    if block.pose.shape != (len(block.step), bodies, width):
        raise ValueError(f"poses have shape {block.pose.shape}")
    for topic, rows in (("/contacts", block.contact), ("/residuals", block.residual)):
        if len(rows) and topic not in topics:
            raise ValueError(f"a block has rows for {topic}, which its log does without")
    return counted(block, posed, touched)


class Nothing:
    """The stream of topics that a log does without."""

    def sizes(self, counted: Counted) -> Rows:
        """Return no byte for any step."""
        return np.zeros(len(counted.block.step), np.int64)

    def part(self, counted: Counted, first: int, last: int) -> Any:
        """Return nothing."""

    def encode(self, prologue: bytes, parts: Sequence[Any], size: int) -> Laid:
        """Refuse: no chunk of it has a byte."""
        raise ValueError("a stream without topics has no chunk")
