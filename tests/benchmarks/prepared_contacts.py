"""The contacts of one step of an engine, as a solver finds them, and solvers that run on them.

The step is made with no sweep allowed: what it leaves in contacts and velocities is what a solver
starts from, impulses of the step before included. Every solver then gets copies of these same
arrays, without an engine around it.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from lavendersim.engine.compile import compiling
from lavendersim.engine.effects import row_fields
from lavendersim.engine.engine import Engine
from lavendersim.engine.kernel_cache import cached
from lavendersim.engine.records import dtype
from lavendersim.engine.solvers import SOLVER_NAMES
from lavendersim.engine.solvers.catalogue import SOLVERS
from lavendersim.engine.solvers.solver import ContactSystem, Solver
from lavendersim.engine.spec import Spec
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of

EVERY_SOLVER = tuple(SOLVER_NAMES)  # by name
SCENES = Path(__file__).parents[2] / "configs" / "scenes"


class Prepared(NamedTuple):
    """What a solver gets of one step."""

    contacts: np.ndarray  # (count,) records
    order: np.ndarray  # (count,) int64
    bodies: np.ndarray
    velocities: np.ndarray
    parameters: np.ndarray
    counters: np.ndarray
    spec: Spec  # what contacts and bodies are made of; sweeps alone


def next_step(engine: Engine, spec: Spec) -> Prepared:
    """Make a step without sweeps and return what its solver found; the engine is spent.

    spec: the engine's, or one with fewer effects, for the solvers.
    """
    engine.parameters["sweeps"] = 0
    bodies = engine.bodies.copy()  # the step moves them
    engine.advance(1)
    count = int(engine.counters["contacts"][0])
    return Prepared(
        engine.contacts[:count].copy(),
        engine.workspace.ordering.order[:count].copy(),
        bodies,
        engine.velocities.copy(),
        engine.parameters,
        engine.counters,
        spec.without("newton", "supernodes")._replace(shape_pairs=()),
    )


def prepare(text: str, step: int) -> Prepared:
    """Run a config up to `step` and return what the solver of the next one finds."""
    (cell,) = load_experiment_text(text, "benchmark.yaml").cells()
    spec = plan_of(cell.config, record=False).spec
    engine = build(cell.config, spec).engine(spec)
    engine.advance(step)
    return next_step(engine, spec)


def _scene_of(name: str) -> str:
    """Return scene, numerics and duration of a config of the repository."""
    text = (SCENES / f"{name}.yaml").read_text()
    return text[text.index("scene:") : text.index("measure:")]


def pyramid(base: int) -> str:
    """Return the pyramid of 210 boxes, with another number of them in its lowest row."""
    scene = _scene_of("pyramid")
    assert "base_count: 20" in scene
    return scene.replace("base_count: 20", f"base_count: {base}")


def pile(layers: int) -> str:
    """Return the pile of a thousand spheres, of which each layer of the start has forty."""
    scene = _scene_of("pile")
    assert "counts: [8, 5, 25]" in scene
    return scene.replace("counts: [8, 5, 25]", f"counts: [8, 5, {layers}]")


class Solve:
    """One solver on the contacts of one step, any number of times."""

    def __init__(
        self,
        prepared: Prepared,
        solver: str | Solver,
        tolerance: float | None = None,
        anew: bool = False,
    ) -> None:
        """Compile or load the solver, the engine's by its name; anew: compile in any case."""
        declared = SOLVERS[solver] if isinstance(solver, str) else solver
        self.name, self.count = declared.name, len(prepared.contacts)
        self._prepared = prepared
        spec = prepared.spec._replace(solver=declared.name, tolerance=tolerance is not None)
        held = prepared.contacts.dtype
        fields = [(field, held[field].str[1:]) for field in held.names or ()]
        self._initial = np.zeros(self.count, dtype(fields, declared.contact_fields))
        for field, _ in fields:
            self._initial[field] = prepared.contacts[field]
        self.contacts, self.velocities = self._initial.copy(), prepared.velocities.copy()
        self._parameters, self._counters = prepared.parameters.copy(), prepared.counters.copy()
        self._parameters["tolerance"] = -1.0 if tolerance is None else tolerance
        self._parameters["sweeps"] = 0
        self.workspace = declared.allocate(spec, len(prepared.bodies), self.count)
        system = ContactSystem(
            self.contacts, prepared.order, self.count, prepared.bodies, self.velocities
        )
        residual_rows = np.zeros(0, dtype(row_fields(spec, "residual")))
        self._arguments = (
            system, self.workspace, self._parameters[0], self._counters[0], residual_rows
        )  # fmt: skip
        kernel = cached(declared.make, spec)
        kernel._cache.anew = anew
        begin = time.perf_counter()
        with compiling():
            kernel(*self._arguments)
        self.compile_s = time.perf_counter() - begin
        self.loaded = kernel._cache.hits > 0
        (compiled,) = kernel.overloads.values()
        self._entry = compiled.entry_point

    def run(self, sweeps: int, now: Callable[[], int] = time.perf_counter_ns) -> int:
        """Solve from the start with at most so many sweeps; return the time [ns] by a clock."""
        self.contacts[...] = self._initial
        self.velocities[...] = self._prepared.velocities
        self._parameters["sweeps"] = sweeps
        begin = now()
        self._entry(*self._arguments)
        return now() - begin

    @property
    def sweeps(self) -> int:
        """Sweeps made by the last run."""
        return int(self._counters["sweeps"][0])

    @property
    def residual(self) -> float:
        """What the last run said of its error [m/s]."""
        return float(self._counters["residual"][0])

    @property
    def impulses(self) -> np.ndarray:
        """Of every contact along n, t1, t2, shape (count, 3) [N s]."""
        return np.stack([self.contacts[f"lambda_{axis}"] for axis in "n12"], axis=1)
