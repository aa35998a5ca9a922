"""Perturbed starts as an axis of any experiment: the start as written, and others drawn by seed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

from lavendersim.errors import UsageError

AXIS: Final = "start_seed"
PATH: Final = "scene.perturbation.seed"
MOST: Final = 1000
COMPARED: Final = 3  # starts where engines are compared and nobody says how many


def starts_of(asked: int | None, engines: Sequence[str]) -> int | None:
    """Return how often a case starts: as asked, else several times where engines are compared."""
    return COMPARED if asked is None and len(engines) > 1 else asked


def overrides_of(starts: int | None) -> list[str]:
    """Return the option that has an experiment start so many times; none for one or none."""
    if starts is None or starts == 1:
        return []
    if not 1 <= starts <= MOST:
        raise UsageError(f"--starts: expected 1 to {MOST}, found {starts}")
    return [f"sweep {AXIS}={PATH}:{list(range(starts))}"]


def start_of(coordinates: Mapping[str, Any]) -> int | None:
    """Return the seed of a cell's start; None where starts are not swept."""
    seed = coordinates.get(AXIS)
    return None if seed is None else int(seed)


def spread_of(worst: Mapping[int, float]) -> tuple[float, float] | None:
    """Return the least and the greatest of what each start shows, by seed; None of one alone."""
    return (min(worst.values()), max(worst.values())) if len(worst) > 1 else None
