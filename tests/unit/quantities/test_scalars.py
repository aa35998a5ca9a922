"""Plain scalars are read as YAML 1.2 core says, and ratios keep their exact value."""

from __future__ import annotations

import copy
import pickle
from fractions import Fraction

import pytest

from lavendersim.quantities.scalars import Ratio, ScalarError, exact, label, resolve


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("12", 12),
        ("012", 12),  # YAML 1.1 reads ten
        ("-0", 0),
        ("+7", 7),
        ("0o17", 15),
        ("0x1F", 31),
        ("1e-3", 0.001),  # YAML 1.1 reads a text
        ("1.", 1.0),
        (".5", 0.5),
        ("-.5E+2", -50.0),
        ("true", True),
        ("FALSE", False),
        ("null", None),
        ("~", None),
        ("", None),
    ],
)
def test_core_schema_scalar(text: str, value: object) -> None:
    read = resolve(text)
    assert read == value
    assert type(read) is type(value)


@pytest.mark.parametrize(
    "text", ["yes", "on", "No", "12:30", "1_000", "0b11", "1e", "e3", ".", "-", "1/", "/2", "1/2/3"]
)
def test_everything_else_is_text(text: str) -> None:
    assert resolve(text) == text


@pytest.mark.parametrize("text", [".inf", "-.INF", ".nan", "1e400", "-1e999", "1/0", "9" * 65])
def test_number_of_no_use_is_refused(text: str) -> None:
    with pytest.raises(ScalarError):
        resolve(text)


def test_ratio_is_a_float_that_keeps_its_exact_value() -> None:
    ratio = resolve("1/480")
    assert isinstance(ratio, Ratio)
    assert ratio == 1 / 480
    assert ratio.fraction == Fraction(1, 480)
    assert label(ratio) == "1/480"


def test_ratio_survives_copies_and_processes() -> None:
    ratio = Ratio(Fraction(1, 3))
    for made in (copy.deepcopy(ratio), pickle.loads(pickle.dumps(ratio))):
        assert made.fraction == Fraction(1, 3)


def test_decimal_is_exact_as_written() -> None:
    assert exact(0.002) == Fraction(1, 500)  # the float itself is no such ratio
    assert exact(0.123456) == Fraction(123456, 1_000_000)
    assert exact(1e-9) == Fraction(1, 10**9)
    assert exact(12345678.25) == Fraction(49382713, 4)


@pytest.mark.parametrize("ratio", [Fraction(5, 6), Fraction(1, 240), Fraction(7919, 999_983)])
def test_a_ratio_that_was_rounded_is_found_again(ratio: Fraction) -> None:
    assert exact(float(ratio)) == ratio
    assert Fraction(0.002) != Fraction(1, 500)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.8, "0.8"),
        (1.0, "1"),
        (1e-06, "1e-06"),
        (Fraction(1, 16), "1/16"),
        (True, "true"),
        ("keep", "keep"),
        ((0, 0.5, Fraction(1, 3)), "[0, 0.5, 1/3]"),
    ],
)
def test_label_text(value: object, text: str) -> None:
    assert label(value) == text
