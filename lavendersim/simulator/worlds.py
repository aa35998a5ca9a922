"""The cells of a sweep stepped together from Python, without logs: `engine.worlds` from a config.

```python
worlds = worlds_of("sweep.yaml")
worlds.advance(240, threads=2)                # one call of a kernel
heights = [engine.take_rows().pose[-1, 1, 2] for engine in worlds.engines]
```

It pays where steps are long beside what Python does with them: `lavender run` writes, checks and
measures every step, and shares that among processes.
"""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from typing import Any, Final

from lavendersim.engine.worlds import Worlds
from lavendersim.errors import UsageError
from lavendersim.experiment import Experiment, load_experiment
from lavendersim.experiment.cell import Cell
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of_cell, union

KEPT: Final = 256  # steps whose rows an engine has room for by default


def worlds_of(
    config: str | PathLike[str] | Mapping[str, Any] | Experiment, kept: int = KEPT
) -> Worlds:
    """Return a world of each cell of a config, at its start, in their order.

    kept: for how many steps rows are kept until they are taken. UsageError where cells need
    different kernels, or have what happens between steps.
    """
    experiment = config if isinstance(config, Experiment) else load_experiment(config)
    cells = experiment.cells()
    for cell in cells:
        _check(experiment.name, cell)
    plan = union(map(plan_of_cell, cells))
    engines = [build(cell.config, plan.spec).engine(plan.spec, kept) for cell in cells]
    try:
        return Worlds(engines)
    except ValueError as error:  # bodies, pairs or sweeps differ in number
        raise UsageError(f"{experiment.name}: {error}") from None


def _check(name: str, cell: Cell) -> None:
    config = cell.config
    if config.engine is not None:
        raise UsageError(f"{name}: engine {config.engine.name} does not step worlds together")
    if config.events or config.triggered:
        raise UsageError(f"{name}: events happen between steps: `lavender run` does them")
