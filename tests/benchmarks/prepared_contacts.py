"""A scene enters; the contacts of one of its steps leave, as its solver finds them, and solvers.

The engine runs the scene with its own solver up to the step. The step itself is made with no sweep
allowed: what it leaves in contacts and velocities is what a solver starts from, impulses of the
step before included. Every solver then gets copies of these same arrays, without an engine around.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from lavendersim.engine.compile import compiling
from lavendersim.engine.effects import newton
from lavendersim.engine.kernel_cache import cached
from lavendersim.engine.records import dtype
from lavendersim.engine.solvers import SOLVERS
from lavendersim.engine.spec import Spec
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of

SCENES = Path(__file__).parents[2] / "configs" / "scenes"
ORDER = 6  # of an engine's working arrays: the order of sweeps


class Prepared(NamedTuple):
    """What solvers get of one step."""

    name: str
    step: int
    contacts: np.ndarray  # (count,) records
    order: np.ndarray
    bodies: np.ndarray
    velocities: np.ndarray
    parameters: np.ndarray
    counters: np.ndarray
    spec: Spec  # of the engine; its effects say what a contact is


def prepare(name: str, text: str, step: int) -> Prepared:
    """Run a config up to `step` and return what the solver of the next step would find."""
    (cell,) = load_experiment_text(text, f"{name}.yaml").cells()
    spec = plan_of(cell.resolved, record=False).spec
    engine = build(cell.resolved, spec).engine(spec)
    engine.advance(step)
    sweeps = int(engine.parameters["sweeps"][0])
    engine.parameters["sweeps"] = 0
    engine.advance(1)
    engine.parameters["sweeps"] = sweeps
    count = int(engine.counters["contacts"][0])
    return Prepared(
        name,
        step,
        engine.contacts[:count].copy(),
        engine._work[ORDER][:count].copy(),
        engine.bodies,
        engine.velocities.copy(),
        engine.parameters,
        engine.counters,
        spec.without(newton.NAME),  # sweeps alone
    )


def pyramid(base: int) -> str:
    """Return the config of the pyramid of 210 with another number of boxes in its lowest row."""
    stated = (SCENES / "pyramid.yaml").read_text()
    scene = stated[stated.index("scene:") : stated.index("measure:")]
    assert "base_count: 20" in scene
    return scene.replace("base_count: 20", f"base_count: {base}")


def pile() -> str:
    """Return the config of the pile of a thousand spheres."""
    stated = (SCENES / "pile.yaml").read_text()
    return stated[stated.index("scene:") : stated.index("measure:")]


class Solve:
    """One solver on the contacts of one step, any number of times."""

    def __init__(self, prepared: Prepared, solver: str) -> None:
        self.name, self.count = solver, len(prepared.contacts)
        self._prepared = prepared
        spec = prepared.spec._replace(solver=solver, shape_pairs=(), tolerance=False)
        own = getattr(SOLVERS[solver], "CONTACT_FIELDS", [])
        held = prepared.contacts.dtype
        fields = [(field, held[field].str[1:]) for field in held.names or ()]
        self._initial = np.zeros(self.count, dtype(fields, own))
        for field, _ in fields:
            self._initial[field] = prepared.contacts[field]
        self.contacts, self.velocities = self._initial.copy(), prepared.velocities.copy()
        self._parameters, self._counters = prepared.parameters.copy(), prepared.counters.copy()
        self._parameters["tolerance"] = 0.0
        allocate = getattr(SOLVERS[solver], "allocate", None)
        space = allocate(spec, len(prepared.bodies), self.count) if allocate else ()
        rows = np.zeros(0, np.dtype([("step", "i8"), ("sweep", "i8"), ("residual", "f8")]))
        self._arguments = (
            self.contacts, prepared.order, self.count, prepared.bodies, self.velocities, space,
            self._parameters[0], self._counters[0], rows,
        )  # fmt: skip
        kernel = cached(SOLVERS[solver].make, spec)  # its code is kept on disk
        begin = time.perf_counter()
        with compiling():
            kernel(*self._arguments)
        self.compile_s = time.perf_counter() - begin
        (compiled,) = kernel.overloads.values()
        self._entry = compiled.entry_point

    def run(self, sweeps: int, now: Any) -> tuple[int, int]:
        """Solve from the start; return the time [ns] by the clock `now`, and the sweeps made."""
        self.contacts[...] = self._initial
        self.velocities[...] = self._prepared.velocities
        self._parameters["sweeps"] = sweeps
        begin = now()
        self._entry(*self._arguments)
        spent = now() - begin
        return spent, int(self._counters["sweeps"][0])
