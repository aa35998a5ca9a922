"""What a measure of a config is: its meaning in one line, and its unit.

Both come from the docstring of its model, which has the unit in brackets: `Speed [m/s] of ...`.
"""

from __future__ import annotations

import inspect
import re
from pathlib import Path
from typing import Final, NamedTuple

from pydantic.fields import FieldInfo

from lavendersim.measures.specs.base import Measure
from lavendersim.measures.specs.catalogue import KINDS
from lavendersim.measures.specs.own import FromFile

RATIO: Final = "-"
_UNIT: Final = re.compile(r"\s*\[(?P<unit>[^\]]*)\]")


def meaning_of(spec: Measure) -> tuple[str, str]:
    """Return meaning and unit; the unit is `-` of a ratio, empty of a number of something."""
    meaning, unit = meaning_of_kind(type(spec))
    if isinstance(spec, FromFile):
        meaning, unit = _meaning_and_unit(spec.meaning or spec.function)
    if getattr(spec, "reduce", "") == "count":
        meaning, unit = f"{meaning}; how many bodies have one", RATIO
    form = spec.over or spec.against
    if form is None:
        return meaning, unit
    relation = "over" if spec.over else "relative distance from"
    return f"{meaning}; {relation} {form.form}", RATIO


def meaning_of_kind(model: type[Measure]) -> tuple[str, str]:
    """Return meaning and unit of a kind; the unit is empty where it depends on a parameter."""
    return _meaning_and_unit(" ".join((inspect.getdoc(model) or "").split()))


def _meaning_and_unit(text: str) -> tuple[str, str]:
    first = re.split(r"(?<=[^.])\. ", text, maxsplit=1)[0].rstrip(".")
    units = set(_UNIT.findall(first))
    return _UNIT.sub("", first), units.pop() if len(units) == 1 else ""


class Described(NamedTuple):
    """A kind of measure, in words."""

    meaning: str
    unit: str
    package: str  # of the kinds of other packages; the file of a project's own
    parameters: dict[str, str]


def described_kinds(own: Path | None = None) -> dict[str, Described]:
    """Return all kinds that a config may name, those of other packages last.

    own: a file of measures, which is run.
    """
    found = {kind: _described(model) for kind, model in KINDS.items() if model is not FromFile}
    if own is not None:
        from lavendersim.measures.own_file import read_own  # late: it needs numpy

        for kind, one in read_own(own).kinds.items():
            meaning, unit = _meaning_and_unit(one.meaning)
            keys = {name: _default(info).strip() for name, info in one.model.model_fields.items()}
            found[kind] = Described(meaning, unit, own.name, keys)
    return found


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
