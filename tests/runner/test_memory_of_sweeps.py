"""A cell of a sweep that is run, measured and judged leaves little in memory: 12 kB at most.

So a sweep of 100,000 cells takes 1.2 GB above what a process takes by itself. What the system gives
it, `tests.benchmarks.sizes` measures; here it is what Python allocates.
"""

from __future__ import annotations

import gc
import tracemalloc
from pathlib import Path

from lavendersim.experiment import load_experiment_text
from lavendersim.runner import run
from tests.benchmarks.line_cases import drops, lasting

FEW, MANY = 100, 400  # cells
MOST_BYTES = 12_000  # of a cell


def peak(cells: int, folder: Path) -> int:
    """Return the most memory that Python allocates for so many short drops [B]."""
    experiment = load_experiment_text(lasting(drops(cells), "1/48"), "drops.yaml")
    gc.collect()
    tracemalloc.start()
    try:
        assert len(run(experiment, folder).run.cells) == cells
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_a_cell_more_takes_12_kilobytes_at_most(tmp_path: Path) -> None:
    peak(20, tmp_path)  # what is made once, is made before
    few, many = (peak(cells, tmp_path) for cells in (FEW, MANY))
    assert (many - few) / (MANY - FEW) <= MOST_BYTES
