"""What measures, judgements and figures need of a log and of a cell of a sweep: types alone."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from lavendersim.cell import AnyEvent, CellConfig
from lavendersim.clock import Clock

Floats = NDArray[np.float64]
Rows = NDArray[np.void]  # structured array, one row per step or contact
Value = float | Floats


class Trace(Protocol):
    """The log of one cell, column by column (see lavendersim/trace)."""

    @property
    def step(self) -> Any:
        """Structured rows, one per logged step; row 0 is the initial state."""

    def steps_in_parts(self) -> Iterator[Any]:
        """Yield the rows of `step` in parts, read as they are asked for."""

    @property
    def contact(self) -> Any:
        """Structured rows, one per contact, grouped by rising step.

        Where the log has no /contacts, for nothing could touch, no column of it can be asked for:
        LavenderError, one sentence.
        """

    def contacts_in_parts(self) -> Iterator[Any]:
        """Yield the rows of `contact` in parts of whole steps; none where the log has none."""

    @property
    def pose(self) -> Any:
        """Rows, bodies, 7: x y z [m] and quaternion w x y z."""

    def poses_in_parts(self) -> Iterator[tuple[Any, Any]]:
        """Yield the rows of `pose` in parts with the numbers of their steps."""

    @property
    def velocity(self) -> Any:
        """Rows, bodies, 6: vx vy vz [m/s], wx wy wz [rad/s], world axes; UsageError without any."""

    @property
    def residual(self) -> Any:
        """Structured rows: step, sweep, residual [m/s]; LavenderError as for contacts."""

    @property
    def bodies(self) -> Sequence[str]:
        """Names of the bodies in the order of their indices."""

    @property
    def config(self) -> CellConfig:
        """The cell's config with every default filled in."""

    @property
    def events(self) -> Sequence[AnyEvent]:
        """What happened to it and when; of events with a trigger, those whose state was met."""

    @property
    def clock(self) -> Clock:
        """Exact times and lengths of its steps; logged times are whole nanoseconds."""

    @property
    def absent(self) -> Mapping[str, str]:
        """Topics that the log does without, and why."""

    @property
    def status(self) -> str:
        """`complete`, or why the run stopped."""


class Cell(Protocol):
    """One cell of a sweep that has been run."""

    @property
    def index(self) -> int:
        """Its place in the sweep, from 0."""

    @property
    def label(self) -> str:
        """Its coordinates in words."""

    @property
    def coordinates(self) -> Mapping[str, Any]:
        """Axis name: swept value."""

    @property
    def path(self) -> Path:
        """The file of its log."""

    @property
    def status(self) -> str:
        """`complete`, or why it stopped."""

    @property
    def config(self) -> CellConfig:
        """Its config with every default filled in."""

    def trace(self) -> Trace:
        """Open its log."""
