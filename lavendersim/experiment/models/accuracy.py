"""The rule of an accuracy that is asked for: what its error estimates hold for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

from lavendersim.experiment.text.place import Place

# Steps of order 2, impacts at their times: else halves of a step tell nothing of its error.
_LAWS: Final = (("impacts", "in_order"), ("integrator", "midpoint_contact"))


def is_of_order_two(numerics: Mapping[str, Any]) -> bool:
    """Whether the errors of substeps can be estimated under these numerics."""
    laws = all(numerics[key] == needed for key, needed in _LAWS)
    return laws and not numerics["stabilisation_gain"] > 0


def accuracy_rules(at: Place) -> None:
    """Refuse an accuracy beside laws of lower order, and bounds of substeps that exclude all."""
    accuracy = at.get("numerics", "accuracy")
    if accuracy is None or accuracy.content is None:
        return
    for key, needed in _LAWS:
        value = at.get("numerics", key)
        if value is not None and value.text != needed:
            mark = max(accuracy.mark, value.mark)  # swept values stand below what they replace
            at.refuse(mark, f"accuracy: needs {key}: {needed}, found {value.text}")
    gain = at.get("numerics", "stabilisation_gain")
    if gain is not None and (gain.number or 0.0) > 0.0:
        sentence = f"accuracy: needs stabilisation_gain: 0, found {gain.number:g}"
        at.refuse(max(accuracy.mark, gain.mark), sentence)
    tolerance = at.get("numerics", "tolerance")
    if tolerance is not None and tolerance.content is None:
        sentence = "accuracy: needs a tolerance, by which steps are solved; found null"
        at.refuse(max(accuracy.mark, tolerance.mark), sentence)
    smallest = at.get("numerics", "smallest_timestep")
    longest = at.node.number_at("numerics", "timestep") or math.inf
    if smallest is not None and (smallest.number or 0.0) > longest:
        found = f"expected at most the timestep, {float(longest):g} s, found {smallest.number:g}"
        at.refuse(max(accuracy.mark, smallest.mark), f"smallest_timestep: {found}")
