"""Measures of logs, and verdicts on what was expected of them. Its names are imported when used.

The models of its sections of a config (`specs`) are light; what takes a measure needs numpy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lavendersim.measures.always import outcomes_of
    from lavendersim.measures.controls import meant_to_end_early
    from lavendersim.measures.interfaces import Trace
    from lavendersim.measures.judging import judge, judge_nodes
    from lavendersim.measures.registration import measure
    from lavendersim.measures.registry import applies, evaluate
    from lavendersim.measures.specs.base import Measure
    from lavendersim.measures.typed_functions import own_measure
    from lavendersim.measures.values import Values
    from lavendersim.measures.verdict import Verdict

_HOME = {
    "Measure": "specs.base",
    "Trace": "interfaces",
    "Values": "values",
    "Verdict": "verdict",
    "applies": "registry",
    "evaluate": "registry",
    "judge": "judging",
    "judge_nodes": "judging",
    "meant_to_end_early": "controls",
    "measure": "registration",
    "outcomes_of": "always",
    "own_measure": "typed_functions",
}

__all__ = [
    "Measure",
    "Trace",
    "Values",
    "Verdict",
    "applies",
    "evaluate",
    "judge",
    "judge_nodes",
    "meant_to_end_early",
    "measure",
    "outcomes_of",
    "own_measure",
]


def __getattr__(name: str) -> Any:
    """Import a public name from its module."""
    if name in _HOME:
        return getattr(import_module(f"lavendersim.measures.{_HOME[name]}"), name)
    raise AttributeError(f"module 'lavendersim.measures' has no attribute {name!r}")
