"""The tables of docs/measures.md, made from the models and functions of the measures.

They stand between the markers `<!-- table of ... -->` and `<!-- end of table -->`; the prose around
them is written by hand.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator
from importlib import import_module
from typing import Any, Final

from config_tables import models_of
from markdown_tables import escaped
from pydantic import BaseModel

from lavendersim.measures.closed_forms import FORMS
from lavendersim.measures.specs.always import Always
from lavendersim.measures.specs.base import Measure
from lavendersim.measures.specs.catalogue import KINDS
from lavendersim.measures.specs.expectation import CELL_JUDGEMENTS, SWEEP_JUDGEMENTS, ExpectSpec

FAMILIES: Final = "lavendersim.measures.kinds"
BLOCK: Final = re.compile(
    r"(?P<begin><!-- table of (?P<name>[a-z ]+) -->\n).*?(?P<end><!-- end of table -->\n)", re.S
)
EVERY_MEASURE: Final = {*Measure.model_fields, "kind"}


def with_measure_tables(text: str) -> str:
    """Return a document with every table between markers made anew."""

    def made(block: re.Match[str]) -> str:
        table = "\n".join(TABLES[block["name"]]())
        return f"{block['begin']}{table}\n{block['end']}"

    return BLOCK.sub(made, text)


def measures() -> Iterator[str]:
    """Yield the lines of the tables of all kinds of this package, family by family."""
    families: dict[str, dict[str, type[Measure]]] = {}
    for kind, model in KINDS.items():
        package, _, family = model.__module__.rpartition(".")
        if package == "lavendersim.measures.specs":
            families.setdefault(family, {})[kind] = model
    for number, (family, models) in enumerate(families.items()):
        yield from ["", f"### {family.capitalize()}"] if number else [f"### {family.capitalize()}"]
        yield from [_first_line(import_module(f"{FAMILIES}.{family}")), ""]
        yield from _head("kind", "value", "parameters")
        for kind, model in models.items():
            yield _row(f"`{kind}`", _text(model), parameters(model, EVERY_MEASURE))


def forms() -> Iterator[str]:
    """Yield the lines of the table of closed forms."""
    yield from _head("form", "bodies", "value")
    for name, function in FORMS.items():
        _, *bodies = inspect.signature(function).parameters.values()
        several = [one.name for one in bodies if one.kind == one.VAR_POSITIONAL]
        taken = "any number" if several else ", ".join(one.name for one in bodies)
        yield _row(f"`{name}`", taken or "none", _text(function))


def judgements() -> Iterator[str]:
    """Yield the lines of the table of judgements."""
    yield from _head("judgement", "of", "passes when", "parameters")
    for place, keys in (("a cell", CELL_JUDGEMENTS), ("several cells", SWEEP_JUDGEMENTS)):
        for key in keys:
            info = ExpectSpec.model_fields[key]
            models = models_of(info.annotation)
            what = [info.description or "", *(_text(model) for model in models)]
            keyed = "; ".join(parameters(model, set()) for model in models)
            yield _row(f"`{key}`", place, ". ".join(what), keyed)


def checks() -> Iterator[str]:
    """Yield the lines of the table of the checks of every step."""
    yield from _head("key", "default", "meaning")
    for name, info in Always.model_fields.items():
        default = str(info.default).lower() if isinstance(info.default, bool) else info.default
        yield _row(f"`{name}`", f"`{default}`", info.description or "")


TABLES: Final[dict[str, Callable[[], Iterator[str]]]] = {
    "measures": measures,
    "closed forms": forms,
    "judgements": judgements,
    "checks": checks,
}


def parameters(model: type[BaseModel], without: set[str]) -> str:
    """Return the keys of a model with their meanings, and their defaults where they have one."""
    described = []
    for name, info in model.model_fields.items():
        if name not in without:
            absent = info.is_required() or info.get_default() is None
            default = "" if absent else f" = {_written(info.get_default())}"
            described.append(f"`{info.alias or name}{default}`: {info.description}")
    return "; ".join(described)


def _written(default: Any) -> str:
    if isinstance(default, bool):
        return str(default).lower()
    return str(list(default)) if isinstance(default, tuple) else str(default)


def _first_line(named: Any) -> str:
    return (inspect.getdoc(named) or "").split("\n", 1)[0]


def _text(named: Any) -> str:
    """Return a docstring as one line, its formulas as code."""
    text = " ".join((inspect.getdoc(named) or "").split())
    return re.sub(r"^Return ", "", text).rstrip(".")


def _head(*titles: str) -> list[str]:
    return [_row(*titles), f"|{'---|' * len(titles)}"]


def _row(*cells: str) -> str:
    return f"| {' | '.join(map(escaped, cells))} |"
