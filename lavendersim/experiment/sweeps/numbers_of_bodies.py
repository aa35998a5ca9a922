"""Axes that vary nothing but how bodies start, where and how fast, or how heavy they are.

Cells that differ in these alone are the same but for numbers of `position`, `velocity`, `release`,
`mass` and `density` of single bodies. No rule of a config reads these numbers beside others, but
for one: a phase shifts an impact, so that gravity has to pull. What a file may say of such a cell
is therefore known from one cell of its class and from each value by itself.
"""

from __future__ import annotations

from collections.abc import Hashable
from functools import cache
from typing import Annotated, Any, Final

from pydantic import ConfigDict, TypeAdapter, ValidationError

from lavendersim.cell.body import Release
from lavendersim.experiment.models.bodies import Body
from lavendersim.experiment.models.tree import BODIES
from lavendersim.experiment.sweeps.axes import SweepPoint, SweptAxis
from lavendersim.experiment.text.node import Node, Path
from lavendersim.quantities.model import ConfigModel

_VECTORS: Final = ("position", "velocity")
_MASSES: Final = ("mass", "density")
_PHASE: Final[Path] = ("release", "phase")
_CLEARANCE: Final[Path] = ("release", "clearance")


def varies_numbers(axis: SweptAxis, masses: bool = True) -> bool:
    """Whether an axis says how bodies start, or how heavy they are, and nothing else.

    masses: false counts these as something else.
    """
    return all(_is_of_start(path) or (masses and _is_of_mass(path)) for path in axis.paths)


def class_of(point: SweepPoint, masses: bool = True) -> tuple[Hashable, ...]:
    """Return what cells have in common that differ in such numbers alone; see `varies_numbers`."""
    return tuple((id(axis), _likeness(axis, index, masses)) for axis, index in point.choices)


def is_valid(point: SweepPoint, axis: SweptAxis, root: Node) -> bool:
    """Whether the values of an axis that varies such numbers are ones that their keys take."""
    tree = point.tree(root)
    return all(_fits(tree, path) for path in axis.paths)


def _is_of_start(path: Path) -> bool:
    place = path[len(BODIES) + 1 :]
    if path[: len(BODIES)] != BODIES:
        return False
    return place in (_PHASE, _CLEARANCE) or (len(place) in (1, 2) and place[0] in _VECTORS)


def _is_of_mass(path: Path) -> bool:
    return path[: len(BODIES)] == BODIES and path[len(BODIES) + 1 :] in [(key,) for key in _MASSES]


def _likeness(axis: SweptAxis, index: int, masses: bool) -> Hashable:
    """Return what cells with this value share; without others like it, the index itself."""
    if not varies_numbers(axis, masses):
        return index
    phases = [nodes[index] for path, nodes in axis.places if path[-1] == _PHASE[-1]]
    return tuple(bool(phase.content) for phase in phases)


def _fits(tree: Node, path: Path) -> bool:
    place = path[len(BODIES) + 1 :]
    whole = path[: len(BODIES) + 2] if place[0] in _VECTORS else path
    model = Body if place[0] in (*_VECTORS, *_MASSES) else Release
    try:
        _type_of(model, str(whole[-1])).validate_python(tree.get(*whole).data)
    except ValidationError:
        return False
    return True


@cache
def _type_of(model: type[ConfigModel], key: str) -> TypeAdapter[Any]:
    field = model.model_fields[key]
    typed: Any = Annotated[(field.annotation, *field.metadata, None)]  # None: where it has no other
    return TypeAdapter(typed, config=ConfigDict(strict=True))
