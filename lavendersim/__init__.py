"""lavender: a laboratory for rigid-body contact. The public names, imported when first used."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lavendersim.experiment import Experiment, load_experiment
    from lavendersim.runner import Finished, Run, open_run, run
    from lavendersim.simulator import Simulator
    from lavendersim.trace import Trace, open_trace

__version__ = "0.1.0"

_HOME = {
    "Experiment": "lavendersim.experiment",
    "load_experiment": "lavendersim.experiment",
    "Finished": "lavendersim.runner",
    "Run": "lavendersim.runner",
    "open_run": "lavendersim.runner",
    "run": "lavendersim.runner",
    "Simulator": "lavendersim.simulator",
    "Trace": "lavendersim.trace",
    "open_trace": "lavendersim.trace",
}

__all__ = [
    "Experiment",
    "Finished",
    "Run",
    "Simulator",
    "Trace",
    "load_experiment",
    "open_run",
    "open_trace",
    "run",
]


def __getattr__(name: str) -> Any:
    """Import a public name from its package; numba and its like stay unloaded until needed."""
    if name in _HOME:
        return getattr(import_module(_HOME[name]), name)
    raise AttributeError(f"module 'lavendersim' has no attribute {name!r}")
