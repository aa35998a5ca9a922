"""What a step counts for its row of the trace begins at zero."""

from __future__ import annotations

from typing import Any

from .collide.iteration_limits import limits_of
from .compile import chain, kernel
from .effects import effects_of
from .spec import Spec


def counts_of(spec: Spec) -> list[str]:
    """Return the names of the counters that begin at zero in every step of an engine."""
    shapes = limits_of(spec) if spec.touches else []
    effects = [name for effect in effects_of(spec) for name in effect.counts]
    return list(dict.fromkeys([*shapes, *effects]))


def make_reset_counts(spec: Spec) -> Any:
    """Return `kernel(counters)`, before the first part of a step."""

    def make_reset(name: str) -> Any:
        def reset(counters):
            counters[name] = 0

        return kernel(reset, spec)

    return chain([make_reset(name) for name in counts_of(spec)], spec)
