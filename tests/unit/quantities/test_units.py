"""The hint for a text where a number was expected: converted by the definition of its unit."""

from __future__ import annotations

import math

import pytest

from lavendersim.quantities.units import FACTORS, QUANTITIES, advice

WRITE = "; units are SI and not written, write "


@pytest.mark.parametrize(
    ("text", "unit", "number"),
    [
        ("5 ms", "s", "0.005"),
        ("2min", "s", "120"),
        ("36 km/h", "m/s", "10"),
        ("7.8 g/cm3", "kg/m^3", "7800"),
        ("1/4 mm", "m", "0.00025"),
        ("1/480 s", "s", "1/480"),
        ("1/3 min", "s", "20"),
        ("1e3 mg", "kg", "0.001"),
    ],
)
def test_a_number_with_its_unit_is_reported_in_si(text: str, unit: str, number: str) -> None:
    assert advice(text, unit) == WRITE + number


def test_turns_a_minute_are_two_pi_over_sixty() -> None:
    reported = float(advice("60 rpm", "rad/s").removeprefix(WRITE))
    assert reported == pytest.approx(2.0 * math.pi, rel=1e-14)  # 15 digits are reported


def test_a_frequency_is_its_period_as_an_exact_ratio() -> None:
    assert advice("480 Hz", "s") == "; a frequency is written as its period, 1/480"
    assert advice("2 kHz", "s") == "; a frequency is written as its period, 1/2000"


@pytest.mark.parametrize(
    ("text", "unit", "hint"),
    [
        ("0.5", "m", "; remove the quotes"),
        ("0,5", "m", "; write 0.5"),
        ("1 000 000", "kg", "; write 1000000"),
        (".nan", "m", "; every number must be finite"),
        ("5 kg", "m", "; kg is no unit of length"),
        ("5 furlongs", "m", "; numbers are written without a unit"),
        ("big", "m", ""),
        ("1/0 m", "m", ""),
    ],
)
def test_other_texts(text: str, unit: str, hint: str) -> None:
    assert advice(text, unit) == hint


def test_what_is_no_text_needs_no_hint() -> None:
    assert advice(5, "m") == ""


def test_si_units_convert_by_one_and_every_quantity_has_some() -> None:
    for unit in QUANTITIES:
        if unit != "degree":
            assert FACTORS[unit][unit] == 1
