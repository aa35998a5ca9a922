"""What a measure of a config is: its meaning in one line, and its unit.

Both come from the docstring of its model, which has the unit in brackets: `Speed [m/s] of ...`.
"""

from __future__ import annotations

import inspect
import re
from typing import Final, NamedTuple

from pydantic.fields import FieldInfo

from lavendersim.measures.specs.base import Measure
from lavendersim.measures.specs.catalogue import KINDS

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


class Described(NamedTuple):
    """A kind of measure, in words."""

    meaning: str
    unit: str
    package: str  # of the kinds of other packages
    parameters: dict[str, str]


def described_kinds() -> dict[str, Described]:
    """Return all kinds that a config may name, those of other packages last."""
    return {kind: _described(model) for kind, model in KINDS.items()}


def _described(model: type[Measure]) -> Described:
    meaning, unit = meaning_of_kind(model)
    package = model.__module__.partition(".")[0]
    own = {
        info.alias or name: f"{info.description or ''}{_default(info)}"
        for name, info in model.model_fields.items()
        if name not in {*Measure.model_fields, "kind"}
    }
    return Described(
        meaning, unit, "" if package == __package__.partition(".")[0] else package, own
    )


def _default(info: FieldInfo) -> str:
    if info.is_required() or info.get_default() is None:
        return ""
    default = info.get_default()
    return f" (default {list(default) if isinstance(default, tuple) else default})"
