"""An axis of a sweep as written: the places that it varies, and their values by a list or a range.

    e: {path: scene.bodies.ball.surface.restitution, values: [0.5, 0.8]}
    dt: {path: numerics.timestep, geometric: {from: 1/60, to: 1/480, steps: 3}}
    pair: {paths: [scene.bodies.a.mass, scene.bodies.b.mass], range: {from: 1, to: 2, steps: 4}}
    size: {paths: {scene.bodies.a.mass: [1, 8], scene.bodies.a.shape.radius: [0.1, 0.2]}}

k of `steps` equal steps: from + (to - from) k/steps, geometric from (to/from)^(k/steps); steps + 1
values, both ends among them. Both are calculated in exact numbers where their ends are.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Annotated, Any, ClassVar, Final

from pydantic import Field

from lavendersim.experiment.text.node import Node
from lavendersim.experiment.text.place import Place
from lavendersim.quantities.formula import as_number
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Either, Quantity
from lavendersim.quantities.scalars import exact

MOST_STEPS: Final = 99_999  # a sweep has at most 100,000 cells
_SPANS: Final = ("range", "geometric")
_SOURCES: Final = ("values", *_SPANS)
DIGITS: Final = 12  # of a geometric value that is no exact number


class Interval(ConfigModel):
    """Evenly spaced values: `steps` steps from the first to the last, which both are values."""

    begin: Annotated[float, Quantity()] = Field(alias="from", description="first value")
    end: Annotated[float, Quantity()] = Field(alias="to", description="last value")
    steps: Annotated[int, Quantity(whole=True, minimum=1, maximum=MOST_STEPS)] = Field(
        description="number of steps; one less than there are values"
    )

    @classmethod
    def rules(cls, at: Place) -> None:
        """The ends differ; those of geometric steps are on one side of 0."""
        begin, end = at.get("from").number, at.get("to").number
        if begin is None or end is None:
            return
        if begin == end:
            at.refuse(at.get("to").mark, f"to: expected another number than from, found {end:g}")
        elif at.path[-1] == "geometric" and begin * end <= 0:
            found = f"found {begin:g} and {end:g}"
            sentence = f"from and to: expected two numbers above 0, or two below, {found}"
            at.refuse(at.node.mark, f"geometric: {sentence}")


PathsOf = Annotated[
    Annotated[tuple[str, ...], Field(min_length=1)]
    | Annotated[dict[str, tuple[Any, ...]], Field(min_length=1)],
    Either("a list of paths, or a mapping from paths to lists of values", tuple, dict),
]


class Axis(ConfigModel):
    """One quantity that is varied: a path of this file, or several, and the values it takes."""

    MISPLACED: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("from", "to", "steps"), "write range: {from: ..., to: ..., steps: ...}"
    )

    FORM: ClassVar[str] = "path: ..., values: [...]"

    path: str | None = Field(
        default=None, description="such as scene.bodies.ball.mass or numerics.timestep"
    )
    paths: PathsOf = Field(
        default=(),
        description="instead of `path`: several, moved together to the same values; or a mapping, "
        "each path to its own list, of which the first names the cells",
    )
    values: tuple[Any, ...] | None = Field(
        default=None, min_length=1, description="one cell per value; ratios are kept exactly"
    )
    range: Interval | None = Field(
        default=None, description="instead of `values`: equal steps, {from, to, steps}"
    )
    geometric: Interval | None = Field(
        default=None, description="instead of `values`: equal factors, {from, to, steps}"
    )

    @property
    def every_path(self) -> tuple[str, ...]:
        """All paths, the first first."""
        return ((self.path,) if self.path is not None else ()) + tuple(self.paths)

    @classmethod
    def rules(cls, at: Place) -> None:
        """There are paths, said in one way, and values, said in one way."""
        if not at.refuse_both(("path", "paths")):
            at.lacks("path", "such as scene.bodies.ball.mass or numerics.timestep")
        own = bool(at.get("paths").entries)
        given = [key for key in _SOURCES if at.written(key)]
        if own and given:
            sentence = f"{given[0]}: the paths of {at} have values of their own; keep one"
            at.refuse(at.key(given[0]), sentence)
        elif not own and not given and at.node.entries.keys() & cls.MISPLACED.keys():
            at.doubt()
        elif not own and not given:
            at.lacks("values", "a list, or range or geometric: {from, to, steps}")
        elif len(given) > 1:
            later = max(given, key=at.key)
            at.refuse(at.key(later), f"{at} specifies {' and '.join(given)}; keep one")
        _length_rules(at)


def _length_rules(at: Place) -> None:
    """Each path has as many values as the first."""
    lists = [node for node in at.get("paths").entries.values() if node.items]
    for node in lists[1:]:
        expected, found = len(lists[0].items), len(node.items)
        if found != expected:
            at.refuse(
                node.mark, f"paths: expected {expected} values as of the first, found {found}"
            )


def axis_paths(axis: Node) -> list[str]:
    """Return the paths of an axis as written, the first first."""
    paths = axis.get("paths")
    nodes = [axis.get("path"), *paths.items]
    return [node.text for node in nodes if node.text is not None] + list(paths.entries)


def axis_values(axis: Node) -> tuple[Node, ...]:
    """Return the nodes of the values that name an axis's cells; none of what is refused."""
    for own in axis.get("paths").entries.values():
        return own.items
    for key in _SPANS:
        if span := axis.get(key):
            return _values_of(span, key == "geometric")
    return axis.get("values").items


def _values_of(span: Node, geometric: bool) -> tuple[Node, ...]:
    ends, steps = (span.get("from").number, span.get("to").number), span.get("steps").number
    if ends[0] is None or ends[1] is None or steps is None or not 1 <= steps <= MOST_STEPS:
        return ()
    first, last, count = exact(ends[0]), exact(ends[1]), int(steps)
    if count != steps or first == last or (geometric and first * last <= 0):
        return ()
    if geometric:
        numbers = _geometric(first, last, count)
    else:
        numbers = [as_number(first + (last - first) * k / count) for k in range(count + 1)]
    return tuple(Node(number, span.mark) for number in numbers)


def _geometric(first: Fraction, last: Fraction, steps: int) -> list[float]:
    ratio = last / first
    factor = _root(ratio, steps)
    if factor is not None:
        return [as_number(first * factor**k) for k in range(steps + 1)]
    between = [
        float(f"{float(first) * float(ratio) ** (k / steps):.{DIGITS}g}") for k in range(1, steps)
    ]
    return [as_number(first), *between, as_number(last)]


def _root(ratio: Fraction, degree: int) -> Fraction | None:
    """Return the root of a positive number, where it is a ratio of whole numbers."""
    near = Fraction(
        round(ratio.numerator ** (1 / degree)), round(ratio.denominator ** (1 / degree))
    )
    return near if near**degree == ratio else None
