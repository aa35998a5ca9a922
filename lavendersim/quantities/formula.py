"""Plain arithmetic on numbers and named values: recursive descent over a few kinds of tokens.

    sum      product (("+" | "-") product)*          left to right
    product  signed (("*" | "/") signed)*            left to right
    signed   ("+" | "-") signed | power              -2 ** 2 is -(2 ** 2)
    power    atom ["**" signed]                      from the right
    atom     number | $name | pi | deg | function "(" sum ("," sum)* ")" | "(" sum ")"

Sums, products and whole powers of exact numbers stay exact: `3 * 0.1` is 0.3, and 1 / $rate with
rate 480 is the ratio 1/480. Nothing else can be said: there are no other names, and no code is run.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final, NamedTuple

from lavendersim.quantities.found import nearest, quoted
from lavendersim.quantities.scalars import LARGEST_DENOMINATOR, LONGEST_NUMBER, Ratio

LONGEST_FORMULA: Final = 400  # characters
DEEPEST: Final = 30  # parentheses and signs within one another
MOST_EXPONENT: Final = 1000  # of ** in either direction
EXACT_BITS: Final = 512  # of a numerator or denominator; what is longer goes on as a float

Exact = Fraction | float
Term = Callable[[Mapping[str, Exact]], Exact]

_TOKEN = re.compile(
    r"(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)"
    r"|\$(?P<value>[A-Za-z_][A-Za-z0-9_]*)"
    r"|(?P<name>[A-Za-z_][A-Za-z0-9_]*)"
    r"|(?P<operator>\*\*|[-+*/(),])"
)
_VALUE = re.compile(r"\$([A-Za-z_][A-Za-z0-9_]*)")
_BLANKS: Final = " \t\n"
FIXED: Final = {"pi": math.pi, "deg": math.pi / 180}
FUNCTIONS: Final[Mapping[str, Callable[..., Any]]] = {
    "sqrt": math.sqrt,
    "exp": math.exp,
    "log": math.log,
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "atan": math.atan,
    "abs": abs,
    "min": min,
    "max": max,
}
_SEVERAL: Final = ("min", "max")  # that take any number of arguments


class FormulaError(ValueError):
    """A formula that cannot be read or has no value; the text is a sentence that says why."""


class _Token(NamedTuple):
    kind: str  # number, value, name, operator; "end"
    text: str


@dataclass(frozen=True)
class Formula:
    """A formula that was read; `names`: the values `$name` that it takes."""

    text: str
    names: frozenset[str]
    _term: Term

    def value(self, values: Mapping[str, Exact]) -> float:
        """Return its number: an int, a Ratio or a float; raises FormulaError where it has none."""
        try:
            number = self._term(values)
        except FormulaError:
            raise
        except ZeroDivisionError:
            raise FormulaError(f"{quoted(self.text)} divides by zero") from None
        except (OverflowError, ValueError):
            raise FormulaError(f"{quoted(self.text)} is no finite number") from None
        if isinstance(number, Fraction):
            try:
                return as_number(number)
            except OverflowError:
                raise FormulaError(f"{quoted(self.text)} is no finite number") from None
        if isinstance(number, complex) or not math.isfinite(number):
            raise FormulaError(f"{quoted(self.text)} is no finite number")
        return number

    def with_values(self, texts: Mapping[str, str]) -> str:
        """Return the formula as text with other texts in the places of some `$name`."""
        return _VALUE.sub(lambda match: texts.get(match[1], match[0]), self.text)


def is_formula(text: str, known: Mapping[str, object]) -> bool:
    """Tell whether a text of a config means a formula; known: names that `$` could stand before.

    It takes a `$name`, or calculates with numbers, `pi` and functions alone. A text that calculates
    with a known name is one that lacks its `$`.
    """
    if len(text) > LONGEST_FORMULA:
        return _VALUE.match(text) is not None
    tokens = list(_tokens(text))
    if any(token.kind == "value" for token in tokens):
        return True
    if any(token.kind == "other" for token in tokens):
        return False
    names = {token.text for token in tokens if token.kind == "name"}
    if not names <= {*FUNCTIONS, *FIXED, *known}:
        return False
    calculates = any(token.kind == "operator" and token.text not in "," for token in tokens)
    numbers = any(token.kind == "number" for token in tokens)
    return text in FIXED or (calculates and (numbers or bool(names)))


def read_formula(text: str) -> Formula:
    """Return the formula of a text; raises FormulaError with what is wrong and what is expected."""
    if len(text) > LONGEST_FORMULA:
        sentence = f"a formula of {len(text)} characters, expected at most {LONGEST_FORMULA}"
        raise FormulaError(sentence)
    reader = _Reader(text)
    term = reader.sum()
    reader.expect_end()
    return Formula(text, frozenset(reader.names), term)


def _tokens(text: str) -> Iterator[_Token]:
    place = 0
    while place < len(text):
        if text[place] in _BLANKS:
            place += 1
            continue
        match = _TOKEN.match(text, place)
        if match is None:
            yield _Token("other", text[place])
            place += 1
            continue
        assert match.lastgroup is not None
        yield _Token(match.lastgroup, match[match.lastgroup])
        place = match.end()


def as_number(number: Fraction) -> float:
    """Return an exact number as configs write it: whole, decimal, a simple ratio, else rounded.

    OverflowError for one that is too large for 64 bits.
    """
    if number.denominator == 1 and number.numerator.bit_length() <= 53:
        return int(number)
    odd = number.denominator
    for factor in (2, 5):
        while odd % factor == 0:
            odd //= factor
    simple = max(abs(number.numerator), number.denominator) <= LARGEST_DENOMINATOR
    return Ratio(number) if odd != 1 and simple else float(number)


def _short(number: Exact) -> Exact:
    if isinstance(number, Fraction):
        longest = max(number.numerator.bit_length(), number.denominator.bit_length())
        return float(number) if longest > EXACT_BITS else number
    return number


def _power(base: Exact, exponent: Exact) -> Exact:
    if not -MOST_EXPONENT <= exponent <= MOST_EXPONENT:
        raise FormulaError(f"an exponent of {float(exponent):g}, expected at most {MOST_EXPONENT}")
    if isinstance(base, Fraction) and isinstance(exponent, Fraction) and exponent.denominator == 1:
        whole = int(exponent)
        bits = max(base.numerator.bit_length(), base.denominator.bit_length())
        if bits * abs(whole) <= EXACT_BITS:
            return base**whole
    power: float | complex = float(base) ** float(exponent)
    if isinstance(power, complex):
        raise FormulaError(f"a power {float(exponent):g} of a negative number has no real value")
    return float(power)


class _Reader:
    """One pass over the tokens of a formula."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.names: set[str] = set()
        self._left = [*_tokens(text), _Token("end", "")]
        self._place = 0
        self._depth = 0

    def sum(self) -> Term:
        """Return the term of a sum."""
        self._enter()
        term = self._product()
        while operator := self._take("+", "-"):
            left, right, sign = term, self._product(), 1 if operator == "+" else -1
            term = _binary(left, right, lambda a, b, sign=sign: a + sign * b)  # type: ignore[misc]
        self._depth -= 1
        return term

    def expect_end(self) -> None:
        """Raise the error of what stands behind a whole formula."""
        if self._here.kind != "end":
            raise self._wrong("an operator")

    def _product(self) -> Term:
        term = self._signed()
        while operator := self._take("*", "/"):
            left, right = term, self._signed()
            if operator == "*":
                term = _binary(left, right, lambda a, b: a * b)
            else:
                term = _binary(left, right, lambda a, b: a / b)
        return term

    def _signed(self) -> Term:
        sign = self._take("+", "-")
        if not sign:
            return self._raised()
        self._enter()
        term = self._signed()
        self._depth -= 1
        return term if sign == "+" else lambda values: -term(values)

    def _raised(self) -> Term:
        base = self._atom()
        if not self._take("**"):
            return base
        self._enter()
        exponent = self._signed()
        self._depth -= 1
        return _binary(base, exponent, _power)

    def _atom(self) -> Term:
        kind, text = self._here
        if kind == "number":
            self._place += 1
            if len(text) > LONGEST_NUMBER or abs(float(text)) > 1e300:
                raise FormulaError(f"{quoted(text)} is no number of 64 bits")
            number = Fraction(text) if "e" not in text.lower() else _of_decimal(text)
            return lambda values: number
        if kind == "value":
            self._place += 1
            self.names.add(text)
            return lambda values: values[text]
        if kind == "name":
            self._place += 1
            return self._named(text)
        if self._take("("):
            term = self.sum()
            self._close()
            return term
        raise self._wrong("a number")

    def _named(self, name: str) -> Term:
        if name in FIXED:
            fixed = FIXED[name]
            return lambda values: fixed
        if name not in FUNCTIONS:
            hint = nearest(name, [*FUNCTIONS, *FIXED])
            raise FormulaError(f"{quoted(name)} in {quoted(self.text)} is no function{hint}")
        if not self._take("("):
            raise self._wrong(f'"(" behind {name}')
        arguments = [self.sum()]
        while self._take(","):
            arguments.append(self.sum())
        self._close()
        function = FUNCTIONS[name]
        if len(arguments) > 1 and name not in _SEVERAL:
            raise FormulaError(f"{name} in {quoted(self.text)} takes one number")
        if name == "abs" or name in _SEVERAL:
            return lambda values: function(*(argument(values) for argument in arguments))
        return lambda values: function(float(arguments[0](values)))

    def _close(self) -> None:
        if not self._take(")"):
            raise self._wrong('")"')

    @property
    def _here(self) -> _Token:
        return self._left[self._place]

    def _take(self, *operators: str) -> str:
        """Step over one of these operators and return it; "" where none is next."""
        if self._here.kind != "operator" or self._here.text not in operators:
            return ""
        self._place += 1
        return self._left[self._place - 1].text

    def _enter(self) -> None:
        self._depth += 1
        if self._depth > DEEPEST:
            raise FormulaError(f"{quoted(self.text)} is nested deeper than {DEEPEST} levels")

    def _wrong(self, expected: str) -> FormulaError:
        here = self._here
        sign = "$" if here.kind == "value" else ""
        found = "its end" if here.kind == "end" else quoted(sign + here.text)
        hint = "; a power is written **" if here.text == "^" else ""
        return FormulaError(f"expected {expected} in {quoted(self.text)}, found {found}{hint}")


def _of_decimal(text: str) -> Exact:
    """Return a number with a power of ten: exact where that is short."""
    number = Fraction(repr(float(text)))
    return _short(number)


def _binary(left: Term, right: Term, operation: Callable[[Exact, Exact], Exact]) -> Term:
    return lambda values: _short(operation(left(values), right(values)))
