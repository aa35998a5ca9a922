"""Runs with and without effects that their scene does not require, compared number by number.

An effect is idle where it is compiled in though the plan has it off: its coefficients are zero, or
what it looks for never occurs. A run must equal the one without it under ==, which takes -0.0 for
0.0; no tolerance is needed anywhere. Records of the fuller engine have more columns, so what both
say is compared column by column.
"""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np
from interpreted_steps import interpreted_bench
from laboratory import Bench, planned

from lavendersim.engine.effects import EFFECTS
from lavendersim.engine.spec import Spec
from lavendersim.engine.step import is_compiled

MODULES = {effect.name: effect for effect in EFFECTS}
# What lets a law in that the numerics or the study choose: values of the key that its module names.
LETS_IN: dict[str, tuple[Any, ...]] = {
    "impact_time": ("at_surface", "in_order"),
    "impact_order": ("in_order",),
    "pairwise_impacts": ("pairwise",),
    "sliding_stops": (),
    "overlooked_points": (),
    "midpoint": ("midpoint", "midpoint_contact"),
    "contact_midpoint": ("midpoint_contact",),
    "contact_spring": ("spring",),
    "error_control": (),  # an accuracy, and then it has something to do
    "speculative": (True,),
    "newton": ("adaptive",),
    "least_norm": ("least_norm",),
    "capture_in_sweeps": ("capture_in_sweeps",),
}
LOGS = {  # tables of `Rows`, and the effect that fills each
    "step": "step_log",
    "pose": "step_log",
    "contact": "contact_log",
    "residual": "residual_log",
}
STEPS = 144  # 0.6 s at 240 Hz: what is thrown lands, what bounces comes back, stacks come to rest
PIECES = 12  # that state is looked at after so many parts of a run


def closed(*names: str) -> set[str]:
    """Return the effects and all that they cannot be without."""
    needed = {need for name in names for need in MODULES[name].needs}
    return {*names, *(closed(*needed) if needed else ())}


def may_idle(cell: dict[str, Any], name: str, record: bool = True) -> bool:
    """Whether a scene does not require an effect, and its numerics choose no other law for it."""
    plan = planned(cell, record)
    return not plan.decisions[name].on and all(
        plan.spec.has(other) or _is_let_in(cell, other) for other in closed(name)
    )


def _is_let_in(cell: dict[str, Any], name: str) -> bool:
    chosen = MODULES[name].chosen_by
    return chosen is None or cell[chosen.section][chosen.key] in LETS_IN[name]


class Run:
    """All that an engine says of a scene: its rows, and its state every few steps.

    interpreted: its kernels run as Python functions, which are as exact: a hundredth of the time
    that an engine takes to compile, for so few steps.
    """

    def __init__(
        self, cell: dict[str, Any], spec: Spec, steps: int = STEPS, *, interpreted: bool = False
    ) -> None:
        self.bench = (interpreted_bench if interpreted else Bench)(cell, spec)
        engine, bodies = self.bench.engine, len(self.bench.scene.names)
        pieces, self.tables = [], {}
        for k in range(PIECES):
            pieces.append(self.bench.run(steps // PIECES))
            self.tables[f"bodies {k}"] = engine.bodies[:bodies].copy()
            self.tables[f"velocities {k}"] = engine.velocities[:bodies].copy()
        for name, log in LOGS.items():
            if spec.has(log):
                rows = [getattr(piece, name) for piece in pieces]
                self.tables[name] = np.concatenate(rows)


def differences(one: Run, other: Run, *but: str) -> list[str]:
    """Return which columns, of those that both runs have, are not equal."""
    found = [] if one.bench.status == other.bench.status else ["status"]
    for name in one.tables.keys() & other.tables.keys():
        first, second = one.tables[name], other.tables[name]
        if len(first) != len(second):
            found.append(f"length of {name}")
        elif first.dtype.names is None:
            width = min(first.shape[-1], second.shape[-1])  # poses; velocities may follow
            found += [name] * (not np.array_equal(first[..., :width], second[..., :width]))
        else:
            columns = [column for column in first.dtype.names if column in second.dtype.names]
            found += [
                f"{name}: {column}"
                for column in columns
                if column not in but and not np.array_equal(first[column], second[column])
            ]
    return sorted(found)


def _compile(cell: dict[str, Any], spec: Spec) -> None:
    Bench(cell, spec).engine.advance(1)


def compile_together(engines: Iterable[tuple[dict[str, Any], Spec]]) -> None:
    """Compile engines two at a time; their kernels are kept, and each is as if compiled here.

    One at a time where another worker of the tests has the second core: two processes that compile
    side by side both make the parts that neither has kept yet, 40.0 s of the processor for 13
    engines that take one process 32.5 s. In a process of its own, for what compiling leaves in
    memory would be carried along, and copied by every fork, to the end of the suite.
    """
    workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    processes = 1 if workers >= (os.cpu_count() or 1) else 2
    missing = {spec: cell for cell, spec in engines if not is_compiled(spec)}
    if len(missing) < 2:
        return
    context = multiprocessing.get_context("spawn")  # numba's threads survive no fork
    with ProcessPoolExecutor(processes, mp_context=context) as pool:
        for job in [pool.submit(_compile, cell, spec) for spec, cell in missing.items()]:
            job.result()
