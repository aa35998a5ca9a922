"""Values of plain YAML scalars (1.2 core schema): null, bool, int, float, ratio or text.

Three things differ from PyYAML's own (YAML 1.1) reading: `1e-3` is a number, `012` is twelve, and
`yes`, `on`, `12:30` are text. One thing is ours: `1/480` is a number that keeps its exact ratio.
"""

from __future__ import annotations

import math
import re
from fractions import Fraction
from functools import lru_cache

# Longer numbers carry no more float64 digits, and Python's int() is quadratic in their length.
LONGEST_NUMBER = 64
LARGEST_DENOMINATOR = 1_000_000  # of the ratios that a float is taken for

_INTEGER = re.compile(r"[-+]?[0-9]+\Z")
_OCTAL = re.compile(r"0o[0-7]+\Z")
_HEXADECIMAL = re.compile(r"0x[0-9a-fA-F]+\Z")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?\Z")
_RATIO = re.compile(r"([-+]?[0-9]+)/([0-9]+)\Z")
_INFINITE = re.compile(r"[-+]?\.(inf|Inf|INF)\Z")
_NAN = re.compile(r"\.(nan|NaN|NAN)\Z")


class Ratio(float):
    """A number written as `1/480`: a float everywhere, with the exact value in `.fraction`."""

    fraction: Fraction

    def __new__(cls, fraction: Fraction) -> Ratio:
        """Round to the nearest float64 and keep the exact value beside it."""
        ratio = super().__new__(cls, fraction)
        ratio.fraction = fraction
        return ratio

    def __repr__(self) -> str:
        return str(self.fraction)

    def __getnewargs__(self) -> tuple[Fraction]:  # type: ignore[override]
        """Let the exact value survive copies and processes."""
        return (self.fraction,)


Value = None | bool | int | float | str


class ScalarError(ValueError):
    """A scalar that looks like a number but is none lavender can use; the text says why."""


def exact(number: float) -> Fraction:
    """Return the number as written: a ratio's own, else the simple ratio or decimal that it rounds.

    A time written as 5/6 is a float in the resolved config, and that float lies beside 5/6: an
    event then would act a step late. No decimal of up to six places is read as another ratio.
    """
    return number.fraction if isinstance(number, Ratio) else _as_written(number)


@lru_cache(maxsize=256)  # cells of a sweep have the same times, and each asks for them often
def _as_written(number: float) -> Fraction:
    simple = Fraction(number).limit_denominator(LARGEST_DENOMINATOR)
    return simple if float(simple) == number else Fraction(repr(number))


def label(value: object) -> str:
    """Return how a value reads in labels and messages: ratios as ratios, floats with %g."""
    if isinstance(value, Ratio | Fraction):
        return str(value) if isinstance(value, Fraction) else repr(value)
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(label(item) for item in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {label(item)}" for key, item in value.items()) + "}"
    return str(value)


@lru_cache(maxsize=4096)  # of long lists of numbers, many are alike
def resolve(text: str) -> Value:
    """Return the value of a plain (unquoted) scalar; raises ScalarError for numbers of no use."""
    if text in ("", "~", "null", "Null", "NULL"):
        return None
    if text in ("true", "True", "TRUE"):
        return True
    if text in ("false", "False", "FALSE"):
        return False
    if text[0] not in "+-.0123456789":
        return text
    if _INFINITE.match(text) or _NAN.match(text):
        raise ScalarError(f"{text} is refused: every number must be finite")
    if ratio := _RATIO.match(text):
        _refuse_long(text)
        if int(ratio[2]) == 0:
            raise ScalarError(f"{text} divides by zero")
        return Ratio(Fraction(int(ratio[1]), int(ratio[2])))  # finite: see LONGEST_NUMBER
    for pattern, base in ((_INTEGER, 10), (_OCTAL, 8), (_HEXADECIMAL, 16)):
        if pattern.match(text):
            _refuse_long(text)
            return int(text, base)
    if _FLOAT.match(text):
        _refuse_long(text)
        number = float(text)
        if not math.isfinite(number):
            raise ScalarError(f"{text} is too large for a 64-bit float")
        return number
    return text


def _refuse_long(text: str) -> None:
    if len(text) > LONGEST_NUMBER:
        raise ScalarError(
            f"a number of {len(text)} characters; lavender reads at most {LONGEST_NUMBER}"
        )
