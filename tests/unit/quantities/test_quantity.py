"""Numbers with a unit and bounds: what is taken, what is refused, and how both are described."""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated, Any, Literal

import pytest
from pydantic import BaseModel, ConfigDict, TypeAdapter, ValidationError
from pydantic_core import PydanticCustomError

from lavendersim.quantities.quantity import Either, NumberOrFormula, Position, Quantity, Vector

FORMS: TypeAdapter[Any] = TypeAdapter(
    Annotated[
        Literal["off"] | float | tuple[float, ...] | dict[str, float],
        Either("off, a number, a list or a mapping", "off", float, tuple, dict),
    ]
)


def refusal(quantity: Quantity, value: object) -> str:
    """Return the sentence with which a value is refused."""
    with pytest.raises(PydanticCustomError) as error:
        quantity.check(value)
    return error.value.message()


@pytest.mark.parametrize(
    ("quantity", "words"),
    [
        (Quantity(), "a number"),
        (Quantity("kg", above=0), "a number above 0 [kg]"),
        (Quantity(minimum=0, maximum=1), "a number from 0 to 1"),
        (Quantity(above=0, below=2), "a number above 0 and below 2"),
        (Quantity(minimum=1, whole=True), "a whole number of 1 or more"),
    ],
)
def test_bounds_in_words(quantity: Quantity, words: str) -> None:
    assert quantity.expected == words
    assert refusal(quantity, True) == f"expected {words}, found true"


def test_open_bounds_refuse_their_own_value_and_closed_ones_take_it() -> None:
    assert Quantity(minimum=0, maximum=1).check(1) == 1.0
    for bounds in ({"above": 1}, {"below": 1}):
        assert "found 1" in refusal(Quantity(**bounds), 1)  # type: ignore[arg-type]


def test_kinds_of_numbers() -> None:
    assert isinstance(Quantity().check(1), float)
    assert Quantity(whole=True).check(3.0) == 3
    assert "a whole number" in refusal(Quantity(whole=True), 3.5)
    exact = Quantity(exact=True).check(Fraction(1, 480))
    assert exact == Fraction(1, 480)
    assert Quantity(exact=True).check(0.1) == Fraction(1, 10)  # as written, not as stored
    for value in (float("nan"), float("inf"), 10**400):
        refusal(Quantity(), value)


def test_what_no_number_of_64_bits_can_hold_is_refused_with_its_range() -> None:
    sentence = "expected a number from 1e-50 to 1e+50 [m], found 1e+60"
    assert refusal(Quantity("m", above=0), 1e60).startswith(sentence)
    assert Quantity("m/s").check(1e200) == 1e200  # a speed may be any


def test_a_formula_takes_axes_and_a_text_without_one_is_no_number() -> None:
    assert NumberOrFormula("m").check("2 * $length") == "2 * $length"
    assert "a number or a formula" in refusal(NumberOrFormula("m"), "long")


class Placed(BaseModel):
    model_config = ConfigDict(strict=True)
    place: Position
    axis: Annotated[tuple[float, float], Vector(2, Quantity(), nonzero=True)] = (1.0, 0.0)


def errors(**given: Any) -> list[tuple[tuple[Any, ...], str]]:
    """Return places and sentences of what is refused."""
    with pytest.raises(ValidationError) as error:
        Placed(**given)
    return [(one["loc"], one["ctx"]["sentence"]) for one in error.value.errors()]


def test_a_wrong_number_of_a_vector_is_refused_at_its_own_place() -> None:
    (one,) = errors(place=[0, "far", 0])
    assert one == (("place", 1), 'expected a number [m], found the text "far"')
    assert errors(place=[0, 0])[0][1] == "expected a list of 3 numbers [m], found a list of 2"


def test_a_direction_needs_a_length() -> None:
    ((_, sentence),) = errors(place=[0, 0, 0], axis=[0, 0])
    assert sentence == "expected a list of 2 numbers, not all zero, found only zeros"
    ((_, sentence),) = errors(place=[0, 0, 0], axis=[1e-60, 0])
    assert "1e-50" in sentence


def test_json_schema_has_bounds_and_lengths() -> None:
    schema = Placed.model_json_schema()["properties"]["place"]
    assert (schema["minItems"], schema["maxItems"]) == (3, 3)
    assert {"type": "number"} in schema["items"]["anyOf"]


@pytest.mark.parametrize(
    ("value", "read"),
    [
        ("off", "off"),
        (2, 2.0),
        (2.5, 2.5),
        ([1.0, 2.0], (1.0, 2.0)),
        ((1.0, 2.0), (1.0, 2.0)),
        ({"one": 1.0}, {"one": 1.0}),
    ],
)
def test_a_value_is_read_as_the_first_form_that_it_has(value: Any, read: Any) -> None:
    assert FORMS.validate_python(value) == read


@pytest.mark.parametrize("value", [True, None, "on", b"off"])
def test_a_value_of_no_form_is_refused_by_what_all_forms_are(value: Any) -> None:
    with pytest.raises(ValidationError) as refused:
        FORMS.validate_python(value)
    (error,) = refused.value.errors()
    assert error["type"] == "form"
    assert error["ctx"] == {"expected": "off, a number, a list or a mapping"}


def test_what_has_a_form_is_refused_as_that_alone() -> None:
    with pytest.raises(ValidationError) as refused:
        FORMS.validate_python({"one": "x"})
    assert [error["type"] for error in refused.value.errors()] == ["float_parsing"]


@pytest.mark.parametrize(
    ("value", "form"),
    [(2.0, "[..., ..., ...]"), ({"x": 1, "y": 2, "z": 3}, "[x, y, z]")],
)
def test_what_is_no_list_of_components_is_written_as_one(value: object, form: str) -> None:
    assert errors(place=value)[0][1].endswith(f"; write {form}")
