"""Shipped configs by their own plans against those of families, number by number.

    python -m tests.own_plans [words of names of configs]

Every kernel is compiled that families save the suite, so this takes some minutes. Of each plan of a
config two cells are run for up to 600 steps; columns that both have are compared under ==.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lavendersim.engine.records import DIVERGED, RUNNING
from lavendersim.engine.spec import Spec
from lavendersim.experiment import load_experiment
from lavendersim.experiment.cell import Cell
from lavendersim.pytest_plugin import _is_experiment
from lavendersim.runner.plans import shared_plans
from lavendersim.scene.build import build
from lavendersim.scene.events import EventQueue
from tests.shared_plans import CONFIGS, shared_spec

CELLS, STEPS = 2, 600
TABLES = ("step", "pose", "contact", "residual")


def run(cell: Cell, spec: Spec) -> tuple[int, dict[str, np.ndarray]]:
    """Return how a cell ended and the tables of its steps."""
    scene = build(cell.config, spec)
    engine = scene.engine(spec)
    events = EventQueue(engine, scene, cell.config.events)
    blocks, done, last = [], 0, min(cell.config.steps, STEPS)
    while True:
        events.apply_due(done)
        status = engine.advance(events.next_stop(last) - done)
        done = int(engine.counters["step"][0])
        blocks.append(engine.take_rows())
        if status == DIVERGED or (status == RUNNING and done >= last):
            break
    tables = [np.concatenate(rows) for rows in zip(*blocks, strict=True)]
    return status, dict(zip(TABLES, tables, strict=True))


def differences(cell: Cell, own: Spec, shared: Spec) -> Iterator[str]:
    """Yield what differs between two plans' runs of a cell."""
    (one_end, one), (other_end, other) = run(cell, own), run(cell, shared)
    if one_end != other_end:
        yield "how it ends"
    for name in TABLES:
        if len(one[name]) != len(other[name]):
            yield f"rows of {name}"
            continue
        names = one[name].dtype.names
        for column in (...,) if names is None else names:
            if names is None or column in other[name].dtype.names:
                a, b = one[name][column], other[name][column]
                if not np.array_equal(a, b, equal_nan=a.dtype.kind == "f"):
                    yield name if names is None else f"{name}.{column}"


def widened(file: Path) -> Iterator[tuple[Cell, Spec, Spec]]:
    """Yield cells of a config that a family's plan would run, with both plans."""
    cells, seen = load_experiment(file, True).cells(), Counter[Spec]()
    for cell, plan in zip(cells, shared_plans(cells), strict=True):
        shared = shared_spec(plan)
        seen[plan.spec] += 1
        if shared != plan.spec and seen[plan.spec] <= CELLS:
            yield cell, plan.spec, shared


def main(words: list[str]) -> int:
    """Print every cell that was compared; 1 where one differs."""
    wrong = 0
    for file in sorted(filter(_is_experiment, CONFIGS.rglob("*.yaml"))):
        name = str(file.relative_to(CONFIGS))
        if words and not any(word in name for word in words):
            continue
        for cell, own, shared in widened(file):
            found = list(differences(cell, own, shared))
            wrong += bool(found)
            sentence = f"differs: {', '.join(found)}" if found else "equal"
            print(f"{name} {cell.label} {own.digest()} {shared.digest()}: {sentence}", flush=True)
    print(f"{wrong} cells differ")
    return int(wrong > 0)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
