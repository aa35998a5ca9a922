"""Values of bodies from which an engine's own rule of mixing makes the coefficients of lavender.

Bodies of one surface that all move, or all stay, are one kind: a scene of many bodies has few.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from math import inf, sqrt
from typing import Any, Final, NamedTuple

from lavendersim.cell.mixing import mixed

SAME: Final = 1e-15  # relative, of a coefficient and what a rule makes: round-off
Number = Callable[[float], float]
Pair = tuple[int, int]  # of kinds, or of bodies


def _itself(required: float) -> float:
    return required


def harmonic_mean(a: float, b: float) -> float:
    """Return 2ab / (a + b); 0 of two zeros."""
    return 2.0 * a * b / (a + b) if a + b else 0.0


class Rule(NamedTuple):
    """How an engine mixes a coefficient of two bodies."""

    mix: Callable[[float, float], float]
    inverses: tuple[Number, ...]  # of what is required: values of two bodies alike
    indifferent: float  # what a body has that leaves the choice to the other
    other: Callable[[float, float], float]  # of what is required and one body's: the other's
    words: str  # what it takes


def _quotient(required: float, one: float) -> float:
    return required / one if one else 0.0


def _other_of_harmonic_mean(required: float, one: float) -> float:
    return required * one / (2.0 * one - required) if 2.0 * one > required else inf


RULES: Final[Mapping[str, Rule]] = {
    "product": Rule(lambda a, b: a * b, (sqrt, _itself), 1.0, _quotient, "the product"),
    "least": Rule(min, (_itself,), inf, lambda v, one: v, "the lesser"),
    "larger": Rule(max, (_itself,), 0.0, lambda v, one: v, "the larger"),
    "mean": Rule(
        lambda a, b: 0.5 * (a + b),
        (_itself,),
        0.0,
        lambda v, one: max(0.0, 2.0 * v - one),
        "the mean",
    ),
    "harmonic_mean": Rule(
        harmonic_mean, (_itself,), 1.0, _other_of_harmonic_mean, "the harmonic mean"
    ),
}


class Unmixable(NamedTuple):
    """Two bodies whose coefficient a rule does not make together with those of all others."""

    pair: Pair
    required: float


class Kinds:
    """The surfaces of a scene, apart for bodies that move and bodies that stay."""

    def __init__(self, surfaces: Iterable[tuple[Any, bool]]) -> None:
        """Take surface of each body, and whether it moves."""
        places: dict[tuple[Any, bool], int] = {}
        self.of_bodies = [places.setdefault(one, len(places)) for one in surfaces]
        self.surfaces = [surface for surface, _ in places]
        self.moves = [moves for _, moves in places]
        first: dict[int, list[int]] = {}
        for body, kind in enumerate(self.of_bodies):
            own = first.setdefault(kind, [])
            if len(own) < 2:
                own.append(body)
        self._first = first

    def meeting(self) -> Iterator[Pair]:
        """Yield the kinds of which two bodies may meet, one of them moving."""
        for a in range(len(self.surfaces)):
            if self.moves[a] and len(self._first[a]) > 1:
                yield a, a
            for b in range(a + 1, len(self.surfaces)):
                if self.moves[a] or self.moves[b]:
                    yield a, b

    def bodies_of(self, pair: Pair) -> Pair:
        """Return two bodies of these kinds, in the order of the scene."""
        a, b = self._first[pair[0]], self._first[pair[1]]
        one, other = (a[0], a[1]) if pair[0] == pair[1] else (a[0], b[0])
        return min(one, other), max(one, other)

    def values(self, key: str, rule: Rule) -> list[float] | Unmixable:
        """Return of each body a value such that the rule makes what lavender mixes of any two."""
        required = {
            (a, b): float(getattr(mixed(self.surfaces[a], self.surfaces[b]), key))
            for a, b in self.meeting()
        }
        off: Pair | None = None
        for values in self._tried(key, rule, required):
            wrong = [
                (a, b)
                for (a, b), value in required.items()
                if not abs(rule.mix(values[a], values[b]) - value) <= SAME * value
            ]
            if not wrong:
                return [values[kind] for kind in self.of_bodies]
            off = off or wrong[0]
        assert off is not None
        return Unmixable(self.bodies_of(off), required[off])

    def _tried(self, key: str, rule: Rule, required: Mapping[Pair, float]) -> Iterator[list[float]]:
        most = max(required.values(), default=0.0)
        for inverse in rule.inverses:
            yield [inverse(getattr(surface, key)) for surface in self.surfaces]
        for inverse in rule.inverses:
            yield [inverse(most)] * len(self.surfaces)
        # Two bodies of a kind that meet decide its value; kinds of one body, or that stay, make up
        # for them.
        bound = [a for a, b in required if a == b]
        for inverse in rule.inverses if bound else ():
            own = {kind: inverse(required[kind, kind]) for kind in bound}
            first = bound[0]
            yield [
                own[kind]
                if kind in own
                else rule.other(required[min(kind, first), max(kind, first)], own[first])
                for kind in range(len(self.surfaces))
            ]
        # What moves leaves the choice to what stays, where moving bodies meet nothing else.
        of_fixed = {b if self.moves[a] else a: value for (a, b), value in required.items()}
        moving = min(rule.indifferent, 2.0 * max(1.0, most))
        yield [
            moving if moves else rule.other(of_fixed.get(kind, 0.0), moving)
            for kind, moves in enumerate(self.moves)
        ]


def values_by(
    rules: Mapping[str, str], key: str, surfaces: Sequence[tuple[Any, bool]]
) -> list[float] | Unmixable:
    """Return values of bodies by the rule that an engine declares for a key."""
    return Kinds(surfaces).values(key, RULES[rules[key]])
