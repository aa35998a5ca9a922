"""Models distinguished by their `kind`: those in the files of a package, and those of plug-ins.

A plug-in is a module of another distribution, named by an entry point of a group.
"""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from pkgutil import iter_modules
from types import ModuleType
from typing import Final, TypeVar, get_args

from lavendersim.errors import UsageError
from lavendersim.quantities.model import ConfigModel

Base = TypeVar("Base", bound=ConfigModel)
CATALOGUE: Final = "catalogue"  # the file of a package that lists the kinds of all others


def all_kinds(base: type[Base], package: ModuleType, group: str) -> dict[str, type[Base]]:
    """Return the subclasses of `base` by their kinds, those of a package's files first.

    UsageError for a plug-in that cannot be imported, or has a kind that is taken.
    """
    found: dict[str, type[Base]] = {}
    for file in iter_modules(package.__path__):
        if file.name != CATALOGUE:
            found |= kinds_in(import_module(f"{package.__name__}.{file.name}"), base)
    for entry in sorted(entry_points(group=group)):
        added = _kinds_of(entry, base)
        if taken := sorted(found.keys() & added.keys()):
            raise UsageError(f"{_place(entry)}: there is a {taken[0]!r} already")
        found |= added
    return found


def kinds_in(module: ModuleType, base: type[Base]) -> dict[str, type[Base]]:
    """Return the models of a kind that a module defines."""
    found: dict[str, type[Base]] = {}
    for model in vars(module).values():
        if not (isinstance(model, type) and issubclass(model, base)):
            continue
        if model.__module__ == module.__name__ and "kind" in model.model_fields:
            found[kind_of(model)] = model
    return found


def kind_of(model: type[ConfigModel]) -> str:
    """Return the value of the key `kind` by which a model is chosen."""
    (kind,) = get_args(model.model_fields["kind"].annotation)
    return str(kind)


def _kinds_of(entry: EntryPoint, base: type[Base]) -> dict[str, type[Base]]:
    try:
        module = entry.load()
    except Exception as error:
        raise UsageError(f"{_place(entry)} cannot be imported: {error}") from error
    return kinds_in(module, base)


def _place(entry: EntryPoint) -> str:
    distribution = entry.dist.name if entry.dist is not None else "unknown"
    return f"{entry.group}: {entry.value} of the distribution {distribution}"
