"""Field types for numbers with a unit and bounds, and for vectors of them.

A field is declared as `Annotated[float, Quantity("kg", above=0)]`. The type refuses text, bools and
numbers out of bounds with a sentence of its own, and describes itself to JSON Schema.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite
from typing import Annotated, Any, Final, Union, get_args

from pydantic import (
    BaseModel,
    Discriminator,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    Tag,
    ValidationInfo,
)
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from lavendersim.quantities.formula import FormulaError, read_formula
from lavendersim.quantities.found import found
from lavendersim.quantities.scalars import exact, label
from lavendersim.quantities.units import advice

# Beyond these no product of a few quantities is a number of 64 bits: m r^2 is made of them, its
# inverse, the volume of a hull. A speed may be any: what it becomes ends a run with its step.
LARGEST: Final = 1e50
SMALLEST: Final = 1e-50  # of what is above 0
OF_64_BITS: Final = "; others cannot be simulated in numbers of 64 bits"
_LARGEST: Final[dict[str, float]] = {
    **dict.fromkeys(("m", "kg", "kg/m^3", "kg m^2"), LARGEST),
    "s": 9e9,  # a log counts nanoseconds in 64 bits
}
RATIO_PATTERN = r"^[-+]?[0-9]+/[0-9]+$"
# What an editor can tell of `1/480`, `2 * $r`, `sqrt(2)`: such characters, an operator among them.
FORMULA_PATTERN = r"^([-+*/(),.$ 0-9A-Za-z_]*[$*/(+-][-+*/(),.$ 0-9A-Za-z_]*|pi|deg)$"


def refusal(expected: str, value: object, hint: str = "") -> PydanticCustomError:
    """Return the error that reads `expected ..., found ...`, with a hint behind it."""
    return sentence_error(f"expected {expected}, found {found(value)}{hint}")


def sentence_error(sentence: str) -> PydanticCustomError:
    """Return the error that reads as this sentence, behind the name of the field."""
    return PydanticCustomError("lavender", "{sentence}", {"sentence": sentence})


class Either:
    """Annotation of a union whose members have forms of their own; the first that fits is read.

    forms: of each member in turn. `float` is any number, `tuple` any list, `dict` any mapping or
    model, `object` any value; other types are those alone, texts themselves; a tuple: one of them.
    """

    def __init__(self, expected: str, *forms: Any) -> None:
        self._expected, self._forms = expected, forms

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Return what validates a value."""
        tagged = [Annotated[one, Tag(f"form {k}")] for k, one in enumerate(get_args(source))]
        discriminator = Discriminator(
            self._form_of,
            custom_error_type="form",
            custom_error_message=self._expected,
            custom_error_context={"expected": self._expected},
        )
        union: Any = Union[tuple(tagged)]  # noqa: UP007
        return handler.generate_schema(Annotated[union, discriminator])

    def _form_of(self, value: Any) -> str | None:
        return next((f"form {k}" for k, one in enumerate(self._forms) if _fits(value, one)), None)


def _fits(value: Any, form: Any) -> bool:
    if isinstance(form, tuple):
        return any(_fits(value, one) for one in form)
    if isinstance(form, str):
        return isinstance(value, str) and value == form
    if form is float:
        return isinstance(value, int | float) and not isinstance(value, bool)
    if form is tuple:
        return isinstance(value, tuple | list)
    if form is dict:
        return isinstance(value, dict | BaseModel)
    return form is object or type(value) is form


@dataclass(frozen=True)
class Quantity:
    """One finite number [unit]; `above`, `below` are open bounds, `minimum`, `maximum` closed."""

    unit: str = ""
    above: float | None = None
    below: float | None = None
    minimum: float | None = None
    maximum: float | None = None
    whole: bool = False
    exact: bool = False  # keep the number as a Fraction
    hint: str = ""  # said when the number is out of bounds

    @property
    def expected(self) -> str:
        """The bounds in words, for messages and for the JSON Schema."""
        words = "a whole number" if self.whole else "a number"
        if self.minimum is not None and self.maximum is not None:
            words += f" from {_plain(self.minimum)} to {_plain(self.maximum)}"
        elif self.minimum is not None:
            words += f" of {self.minimum:g} or more"
        elif self.maximum is not None:
            words += f" of {self.maximum:g} or less"
        if self.above is not None:
            words += f" above {self.above:g}"
        if self.below is not None:
            words += f" {'and ' if self.above is not None else ''}below {self.below:g}"
        return words + (f" [{self.unit}]" if self.unit else "")

    def check(self, value: object) -> Any:
        """Return the number as float, int (whole) or Fraction (exact), or raise the refusal."""
        if isinstance(value, bool) or not isinstance(value, int | float | Fraction):
            raise refusal(self.expected, value, advice(value, self.unit))
        if isinstance(value, float) and not isfinite(value):
            raise refusal(self.expected, value)
        if self.whole and not (isinstance(value, int) or float(value).is_integer()):
            raise refusal(self.expected, value)
        if not self._inside(value):
            raise refusal(self.expected, value, f"; {self.hint}" if self.hint else "")
        self._refuse_extremes(value)
        if self.whole:
            return int(value)
        if self.exact:
            return value if isinstance(value, Fraction) else exact(value)
        try:
            return float(value)
        except OverflowError:
            raise refusal(self.expected, value) from None

    def _refuse_extremes(self, value: float | Fraction) -> None:
        """Refuse what cannot be simulated though it is a number, with the range that can be."""
        largest = _LARGEST.get(self.unit)
        if largest is None or value == 0:
            return
        positive = self.above is not None and self.above >= 0
        if not -largest <= value <= largest or (positive and value < SMALLEST):
            low = SMALLEST if positive else 0 if self.minimum is not None else -largest
            expected = f"a number from {low:g} to {largest:g} [{self.unit}]"
            raise refusal(expected, value, OF_64_BITS)

    def _inside(self, value: float | Fraction) -> bool:
        return not (
            (self.above is not None and value <= self.above)
            or (self.below is not None and value >= self.below)
            or (self.minimum is not None and value < self.minimum)
            or (self.maximum is not None and value > self.maximum)
        )

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Validate with `check`; write Fractions as `1/480`."""
        writer = core_schema.plain_serializer_function_ser_schema(label, when_used="json")
        if not self.exact:
            return core_schema.no_info_plain_validator_function(self.check)
        return core_schema.with_info_plain_validator_function(
            self._check_exact, serialization=writer
        )

    def _check_exact(self, value: object, info: ValidationInfo) -> Any:
        """Check a number; in resolved configs (JSON) a ratio is the text `1/480`."""
        if info.mode == "json" and isinstance(value, str):
            value = _ratio(value)
        return self.check(value)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Describe the number, and formulas and ratios as its other spellings."""
        number: dict[str, Any] = {"type": "integer" if self.whole else "number"}
        bounds = {
            "minimum": self.minimum,
            "maximum": self.maximum,
            "exclusiveMinimum": self.above,
            "exclusiveMaximum": self.below,
        }
        number |= {name: bound for name, bound in bounds.items() if bound is not None}
        return {"anyOf": [number, {"type": "string", "pattern": FORMULA_PATTERN}]}


class NumberOrFormula(Quantity):
    """A number, or a formula that takes axes of the sweep, as text: `2 * $length`."""

    def check(self, value: object) -> Any:
        """Return the number as float or the text of the formula, or raise the refusal."""
        if not isinstance(value, str):
            return super().check(value)
        try:
            if read_formula(value).names:
                return value
        except FormulaError:
            pass
        raise refusal("a number or a formula", value, advice(value, self.unit))


def _ratio(text: str) -> Fraction:
    """Return the ratio of a resolved config; one that a log states may be any text."""
    if len(text) > 1000 or not re.fullmatch(RATIO_PATTERN + r"|^[-+]?[0-9]+$", text):
        raise refusal("a ratio such as 1/480", text)
    numerator, _, denominator = text.partition("/")
    if int(denominator or 1) == 0:
        raise refusal("a ratio such as 1/480", text)
    return Fraction(int(numerator), int(denominator or 1))


def _plain(bound: float) -> str:
    return f"{int(bound)}" if float(bound).is_integer() else f"{bound:g}"


@dataclass(frozen=True)
class Vector:
    """A list of `length` numbers, each a `Quantity`; `nonzero` refuses the zero vector."""

    length: int
    item: Quantity
    nonzero: bool = False

    @property
    def expected(self) -> str:
        """The shape in words."""
        return f"a list of {self.length} numbers" + (
            f" [{self.item.unit}]" if self.item.unit else ""
        )

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Validate item by item, so that a wrong item is reported at its own place."""
        item = core_schema.no_info_plain_validator_function(self.item.check)
        items = core_schema.tuple_schema([item] * self.length)
        return core_schema.no_info_wrap_validator_function(self._wrap, items)

    def _wrap(self, value: object, items: Any) -> Any:
        if not isinstance(value, list | tuple) or len(value) != self.length:
            raise refusal(self.expected, value, self._advice(value))
        numbers = items(tuple(value))
        if self.nonzero and not any(numbers):
            raise sentence_error(f"expected {self.expected}, not all zero, found only zeros")
        if self.nonzero and not SMALLEST <= (largest := max(map(abs, numbers))) <= LARGEST:
            expected = f"a largest number from {SMALLEST:g} to {LARGEST:g}"
            raise refusal(f"{self.expected} with {expected}", float(largest), OF_64_BITS)
        return numbers

    def _advice(self, value: object) -> str:
        """Return how what is no list is written as one, or nothing when nothing is sure."""
        if isinstance(value, Mapping):
            return f"; write [{', '.join(map(str, value))}]"
        if isinstance(value, int | float) and not isinstance(value, bool):
            each = [f"{value:g}" if self.item.above is not None else "..."] * self.length
            return f"; write [{', '.join(each)}]"
        if self.nonzero and isinstance(value, str) and value.strip("+-") in ("x", "y", "z"):
            one = "-1" if value.startswith("-") else "1"
            return f"; write [{', '.join(one if value[-1] == axis else '0' for axis in 'xyz')}]"
        return advice(value, self.item.unit)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Describe the list with its length."""
        item = self.item.__get_pydantic_json_schema__(schema, handler)
        return {
            "type": "array",
            "items": item,
            "minItems": self.length,
            "maxItems": self.length,
        }


Vector3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]  # w x y z
Position = Annotated[Vector3, Vector(3, Quantity("m"))]
Velocity = Annotated[Vector3, Vector(3, Quantity("m/s"))]
AngularVelocity = Annotated[Vector3, Vector(3, Quantity("rad/s"))]
Direction = Annotated[Vector3, Vector(3, Quantity(), nonzero=True)]
BoxSize = Annotated[Vector3, Vector(3, Quantity("m", above=0))]
