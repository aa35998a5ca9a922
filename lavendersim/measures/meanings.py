"""What a measure of a config is: its meaning in one line, and its unit.

Both come from the docstring of its model, which has the unit in brackets: `Speed [m/s] of ...`.
"""

from __future__ import annotations

import inspect
import re
from typing import Final

from lavendersim.measures.specs.base import Measure

RATIO: Final = "-"
_UNIT: Final = re.compile(r"\s*\[(?P<unit>[^\]]*)\]")


def meaning_of(spec: Measure) -> tuple[str, str]:
    """Return meaning and unit; the unit is `-` of a ratio, empty of a number of something."""
    meaning, unit = meaning_of_kind(type(spec))
    form = spec.over or spec.against
    if form is None:
        return meaning, unit
    relation = "over" if spec.over else "relative distance from"
    return f"{meaning}; {relation} {form.form}", RATIO


def meaning_of_kind(model: type[Measure]) -> tuple[str, str]:
    """Return meaning and unit of a kind; the unit is empty where it depends on a parameter."""
    text = " ".join((inspect.getdoc(model) or "").split())
    first = re.split(r"(?<=[^.])\. ", text, maxsplit=1)[0].rstrip(".")
    units = set(_UNIT.findall(first))
    return _UNIT.sub("", first), units.pop() if len(units) == 1 else ""
