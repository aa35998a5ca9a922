"""All kinds of measures that a config may name: those of this package, and those of others.

Every model of a measure in a file of `lavendersim/measures/specs` is one. Another distribution adds
its own by an entry point of the group `lavendersim.measures` whose value is a module:

    [project.entry-points."lavendersim.measures"]
    bounce = "my_package.bounce"

The module has the model and the function of each of its kinds, see `lavendersim.measures.measure`.
"""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from pkgutil import iter_modules
from types import ModuleType
from typing import TYPE_CHECKING, Annotated, Final, Union, get_args

from pydantic import Field

from lavendersim.errors import UsageError
from lavendersim.measures import specs
from lavendersim.measures.specs.base import Measure

GROUP: Final = "lavendersim.measures"


def kinds_in(module: ModuleType) -> dict[str, type[Measure]]:
    """Return the models of measures that a module defines, by their kinds."""
    found = {}
    for model in vars(module).values():
        if not (isinstance(model, type) and issubclass(model, Measure)):
            continue
        if model.__module__ == module.__name__ and "kind" in model.model_fields:
            (kind,) = get_args(model.model_fields["kind"].annotation)
            found[kind] = model
    return found


def all_kinds() -> dict[str, type[Measure]]:
    """Return the model of every kind of measure.

    UsageError for a module of another distribution that cannot be imported, or has a kind that is
    taken.
    """
    found: dict[str, type[Measure]] = {}
    for family in iter_modules(specs.__path__):
        if family.name != "catalogue":
            found |= kinds_in(import_module(f"{specs.__name__}.{family.name}"))
    for entry in sorted(entry_points(group=GROUP)):
        added = _kinds_of(entry)
        if taken := sorted(found.keys() & added.keys()):
            raise UsageError(f"{_place(entry)}: there is a measure {taken[0]!r} already")
        found |= added
    return found


def _kinds_of(entry: EntryPoint) -> dict[str, type[Measure]]:
    try:
        module = entry.load()
    except Exception as error:
        raise UsageError(f"{_place(entry)} cannot be imported: {error}") from error
    return kinds_in(module)


def _place(entry: EntryPoint) -> str:
    package = entry.dist.name if entry.dist is not None else "unknown"
    return f"measures {entry.value} of the distribution {package}"


KINDS: Final = all_kinds()

if TYPE_CHECKING:
    MeasureSpec = Measure
else:
    MeasureSpec = Annotated[Union[tuple(KINDS.values())], Field(discriminator="kind")]  # noqa: UP007
