"""About how large the logs of a run will be, and whether the disk has room for them."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Final, NamedTuple

from lavendersim.cell import CellConfig
from lavendersim.engine.effects import effects_of, row_fields
from lavendersim.engine.step_terms import step_terms
from lavendersim.experiment.cell import Cell, alike
from lavendersim.geometry.bodies import is_movable
from lavendersim.scene.expected_contacts import expected_contacts
from lavendersim.scene.plan import Plan
from lavendersim.trace.expected_size import WORD, StepContent, expected_size
from lavendersim.trace.recorded import recorded_states

MOST_OF_DISK: Final = 0.1  # of what is free, that logs take without a warning
# Impacts a step and body beside the contacts that are expected: few have any, in a crowd all.
IMPACTS: Final = 0.25
# More than logs take, by far: twenty contacts of 250 B a body. It is known at once.
MOST_PER_STEP: Final = 1_000  # [B]
MOST_PER_BODY: Final = 5_000  # [B] and step
MOST_SAMPLED: Final = 200  # cells; one takes 0.2 ms


class LogSpace(NamedTuple):
    """What the logs of a run take of the disk that they go to."""

    size: int | None  # [B] about; None: far less than there is
    free: int  # [B]

    @property
    def is_large(self) -> bool:
        """Whether they take more than a tenth of what is free."""
        return self.size is not None and self.size > MOST_OF_DISK * self.free

    def warning(self, root: Path) -> str:
        """Return a sentence for logs that are large; else nothing."""
        if self.size is None or not self.is_large:
            return ""
        return (
            f"its logs take about {self.size / 1e9:.2g} GB, more than a tenth of the "
            f"{self.free / 1e9:.2g} GB that are free in {root}"
        )


def expected_log_size(config: CellConfig, plan: Plan, as_written: str) -> float:
    """Return about how many bytes [B] the log of a cell will have."""
    spec, bodies = plan.spec, config.scene.bodies.values()
    topics = [topic for effect in effects_of(spec) for topic in effect.channels or ()]
    steps = config.steps
    clock, record = config.clock, config.record
    posed, touched = (
        recorded_states(which, clock, steps) / (steps + 1)
        for which in (record.poses, record.contacts)
    )
    moving = sum(is_movable(body) or body.kinematic for body in bodies)
    contacts = expected_contacts(config)
    if step_terms(spec).ordered_impacts:
        contacts += IMPACTS * moving
    content = StepContent(
        step_columns=len(row_fields(spec, "step")),
        contact_columns=row_fields(spec, "contact"),
        moving=posed * moving,
        contacts=touched * contacts if "/contacts" in topics else 0.0,
        sweeps=_logged_sweeps(config, steps),
    )
    return expected_size(content, topics, steps, len(bodies), as_written)


def expected_log_sizes(
    cells: Sequence[Cell], plans: Sequence[Plan], as_written: str, most: int = MOST_SAMPLED
) -> list[int]:
    """Return about how many bytes [B] the log of each cell will have.

    most: cells, evenly among all, of which it is worked out; the others are taken to be like the
    one before them that is among these.
    """
    every = -(-len(cells) // most)
    sizes = [
        round(expected_log_size(cell.config, plan, as_written))
        for cell, plan in zip(cells[::every], plans[::every], strict=True)
    ]
    return [sizes[place // every] for place in range(len(cells))]


def log_space(
    cells: Sequence[Cell],
    plans: Callable[[], Sequence[Plan]],
    as_written: str,
    root: Path,
    always: bool = False,
) -> LogSpace:
    """Return what the logs of a run take of the disk of `root`.

    always: expect a size also where it is certainly small, and planning would take longer.
    """
    free = free_bytes(root)
    if not always and is_certainly_small(cells, free):
        return LogSpace(None, free)
    return LogSpace(sum(expected_log_sizes(cells, plans(), as_written)), free)


def is_certainly_small(cells: Iterable[Cell], free: int) -> bool:
    """Whether logs take little of what is free [B]: known at once, by a bound."""
    return most_bytes_of(cells) <= MOST_OF_DISK * free


def free_bytes(root: Path) -> int:
    """Return what is free on the disk of a folder [B], which need not be made yet."""
    return shutil.disk_usage(existing(root)).free


def most_bytes(cell: Cell) -> float:
    """Return more bytes [B] than the log of a cell takes."""
    config = cell.config
    sweeps = config.numerics.sweeps if config.record.residuals != "none" else 0
    bodies = len(config.scene.bodies)
    return (config.steps + 1) * (MOST_PER_STEP + bodies * MOST_PER_BODY + 2 * WORD * sweeps)


def most_bytes_of(cells: Iterable[Cell]) -> float:
    """Return more bytes [B] than the logs of cells take."""
    return sum(len(one) * most_bytes(one[0]) for one in alike(cells))


def _logged_sweeps(config: CellConfig, steps: int) -> float:
    """Return the sweeps a step whose residuals are logged, at most; the mean over the run."""
    if config.record.residuals == "none":
        return 0.0
    from lavendersim.scene.build import residual_window  # late: numba

    first, last = residual_window(config.record, config.clock)
    return config.numerics.sweeps * max(0, min(last, steps) - first + 1) / steps


def existing(path: Path) -> Path:
    """Return the folder that a path will be made in."""
    path = path.absolute()
    return next(folder for folder in (path, *path.parents) if folder.exists())
