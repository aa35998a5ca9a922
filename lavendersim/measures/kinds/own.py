"""Measures of a Python file beside the config."""

from __future__ import annotations

from lavendersim.measures.interfaces import Trace, Value
from lavendersim.measures.own_file import evaluate_own
from lavendersim.measures.registration import measure
from lavendersim.measures.specs import own as specs


@measure(specs.FromFile)
def from_file(spec: specs.FromFile, trace: Trace) -> Value:
    """Return what the function of the file returns."""
    return evaluate_own(spec, trace)
