"""The value of a measure in one log, by the function that is registered for its kind."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from lavendersim.errors import UsageError
from lavendersim.measures import kinds
from lavendersim.measures.closed_forms import evaluate_form
from lavendersim.measures.interfaces import Trace, Value
from lavendersim.measures.not_finite import without_warnings
from lavendersim.measures.registration import FUNCTIONS
from lavendersim.measures.selection import selects
from lavendersim.measures.specs.catalogue import MeasureSpec

kinds.load_all()


@without_warnings
def evaluate(spec: MeasureSpec, trace: Trace) -> Value:
    """Return the measure of one log: a float, or a 1-D array for kinds that give a row.

    NaN where the log cannot answer, or a closed form to divide by is 0; a row without numbers is a
    row of one NaN, which no judgement passes.
    """
    value = FUNCTIONS[type(spec)](spec, trace)
    return beside_form(spec, value if np.size(value) else np.array([np.nan]), trace)


def beside_form(spec: MeasureSpec, value: Value, trace: Trace) -> Value:
    """Return the value of a measure beside its closed form, where it has one.

    UsageError where that has no value, as a drop from within the plane.
    """
    form = spec.over or spec.against
    if form is None:
        return value
    ideal = evaluate_form(form, trace.config)
    if ideal == 0.0:
        return float("nan")
    if ideal != ideal and not np.isnan(value).all():
        raise UsageError(f"{form.form} has no value in this scene")
    fraction: Value = value / ideal
    return fraction if spec.over else np.abs(fraction - 1.0)


def applies(spec: MeasureSpec, coordinates: Mapping[str, Any]) -> bool:
    """Tell whether the measure is taken in the cell with these coordinates (its `at`)."""
    return selects(spec.at, coordinates)
