"""Engines whose whole step runs in Python's interpreter: no kernel of a scene is compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from interpreted import interpreted, records
from laboratory import Bench

from lavendersim.engine.spec import Spec
from lavendersim.engine.step import make_advance


def interpreted_advance(spec: Spec) -> Callable[..., int]:
    """Return what an engine calls, as a Python function of the same arrays and number of steps."""
    advance = interpreted(make_advance(spec))

    def entry(*arguments: Any) -> int:
        *arrays, steps = arguments
        with np.errstate(over="ignore"):  # hashes of states
            return int(advance(*map(records, arrays), steps))

    return entry


def interpreted_bench(cell: dict[str, Any], spec: Spec | None = None) -> Bench:
    """Return a scene whose engine runs its kernels in the interpreter, for as long as it lives."""
    bench = Bench(cell, spec)
    bench.engine._entry = interpreted_advance(bench.spec)
    return bench


class Steps:
    """A resolved cell at its start, and its steps."""

    def __init__(self, cell: dict[str, Any], spec: Spec | None = None) -> None:
        self.bench = Bench(cell, spec)
        self.engine, self.spec = self.bench.engine, self.bench.spec
        self._advance = interpreted_advance(self.spec)

    def _arrays(self) -> tuple[Any, ...]:
        engine = self.engine
        return engine.state, engine.workspace, engine.log, engine.parameters, engine.counters

    def arrays(self) -> list[Any]:
        """Return state, workspace, log, parameters and counters as kernels read them."""
        return [records(array) for array in self._arrays()]

    def advance(self, steps: int) -> int:
        """Make so many steps; return what the kernel says."""
        return self._advance(*self._arrays(), steps)

    def run(self, steps: int) -> np.ndarray:
        """Make so many steps; return their rows of the log."""
        before = self.engine.counters["step"][0]
        assert self.advance(steps) == 0
        assert self.engine.counters["step"][0] == before + steps
        return self.engine.take_rows().step[-steps:]

    @property
    def counters(self) -> Any:
        """The counters, by name."""
        return records(self.engine.counters)[0]

    def vectors(self, rows: np.ndarray, prefix: str = "") -> np.ndarray:
        """Return the fields x, y, z behind a prefix, (n, 3)."""
        return np.column_stack([rows[f"{prefix}{axis}"] for axis in "xyz"])

    @property
    def places(self) -> np.ndarray:
        """Places of the bodies, (n, 3)."""
        return self.vectors(self.engine.bodies)

    @property
    def velocities(self) -> np.ndarray:
        """Velocities of the bodies, (n, 3)."""
        return self.vectors(self.engine.velocities, "v")
