"""The hint for a text where a number was expected: what to write instead, in SI.

lavender reads SI numbers only. A text such as `5 ms` is refused, never converted: the hint gives
the number to write, so that the file itself says what was meant.
"""

from __future__ import annotations

import math
import re
from fractions import Fraction

from lavendersim.quantities.scalars import ScalarError, resolve

_DEGREE = math.pi / 180.0

# factor from the written unit to the SI unit of the field
FACTORS: dict[str, dict[str, Fraction | float]] = {
    "s": {
        "s": 1.0,
        "ms": Fraction(1, 10**3),
        "us": Fraction(1, 10**6),
        "µs": Fraction(1, 10**6),
        "ns": Fraction(1, 10**9),
        "min": 60.0,
    },
    "m": {
        "m": 1.0,
        "mm": Fraction(1, 10**3),
        "cm": Fraction(1, 10**2),
        "um": Fraction(1, 10**6),
        "µm": Fraction(1, 10**6),
        "km": 1000.0,
    },
    "kg": {"kg": 1.0, "g": Fraction(1, 10**3), "mg": Fraction(1, 10**6), "t": 1000.0},
    "N": {"N": 1.0, "mN": Fraction(1, 10**3), "kN": 1000.0},
    "Hz": {"Hz": 1.0, "kHz": 1000.0},
    "m/s": {
        "m/s": 1.0,
        "mm/s": Fraction(1, 10**3),
        "cm/s": Fraction(1, 10**2),
        "km/h": Fraction(10, 36),
    },
    "m/s^2": {"m/s^2": 1.0, "m/s2": 1.0, "cm/s^2": Fraction(1, 10**2)},
    "rad/s": {"rad/s": 1.0, "deg/s": _DEGREE, "rpm": 6 * _DEGREE},
    "m/N": {
        "m/N": 1.0,
        "mm/N": Fraction(1, 10**3),
        "um/N": Fraction(1, 10**6),
        "µm/N": Fraction(1, 10**6),
        "mm/kN": Fraction(1, 10**6),
    },
    "kg/m^3": {"kg/m^3": 1.0, "kg/m3": 1.0, "g/cm^3": 1000.0, "g/cm3": 1000.0},
    "degree": {"deg": 1.0, "°": 1.0, "degree": 1.0, "degrees": 1.0, "rad": 1 / _DEGREE},
}

QUANTITIES = {
    "s": "time",
    "m": "length",
    "kg": "mass",
    "N": "force",
    "m/s": "speed",
    "m/s^2": "acceleration",
    "rad/s": "angular velocity",
    "m/N": "compliance",
    "kg/m^3": "density",
    "degree": "angle",
}

_WITH_UNIT = re.compile(
    r"([-+]?[0-9.]{1,30}(?:[eE][-+]?[0-9]{1,2}|/[0-9]{1,30})?)\s*([a-zA-Zµ°%][a-zA-Z0-9µ°/^*%]*)\Z"
)
_DECIMAL_COMMA = re.compile(r"[-+]?[0-9]+,[0-9]+\Z")
_GROUPED = re.compile(r"[-+]?[0-9]{1,3}([_ '][0-9]{3})+(\.[0-9]+)?\Z")
_NOT_FINITE = re.compile(r"[-+]?\.?(nan|inf|infinity)\Z", re.IGNORECASE)
_EXPRESSION = re.compile(r"[-+*/^() ]|sqrt|pi")


def advice(value: object, unit: str) -> str:
    """Return what to write instead of this value as `; ...`, or nothing when nothing is sure."""
    if not isinstance(value, str):
        return ""
    text = value.strip()[:80]
    if _is_number(text):
        return "; remove the quotes"
    if _NOT_FINITE.match(text):
        return "; every number must be finite"
    if match := _WITH_UNIT.match(text):
        return _convert(match[1], match[2], unit)
    if _DECIMAL_COMMA.match(text):
        return f"; write {text.replace(',', '.')}"
    if _GROUPED.match(text):
        return f"; write {re.sub(r'[_ ]', '', text).replace(chr(39), '')}"
    if _EXPRESSION.search(text) and any(letter.isdigit() for letter in text):
        return "; a formula has numbers, $constants, + - * / ** and functions such as sqrt"
    return ""


def _is_number(text: str) -> bool:
    try:
        resolved = resolve(text)
    except ScalarError:
        return False
    return isinstance(resolved, int | float) and not isinstance(resolved, bool)


def _convert(digits: str, written_unit: str, unit: str) -> str:
    try:
        number = Fraction(digits)
    except (ValueError, ZeroDivisionError):
        return ""
    if abs(number) > 10**30:
        return ""
    if unit == "s" and written_unit in FACTORS["Hz"] and number > 0:
        return f"; a frequency is written as its period, {1 / (number * _hertz(written_unit))}"
    factors = FACTORS.get(unit, {})
    if written_unit not in factors:
        if unit in QUANTITIES and written_unit in ALL_UNITS:
            return f"; {written_unit} is no unit of {QUANTITIES[unit]}"
        return "; numbers are written without a unit"
    factor = factors[written_unit]
    times = number if isinstance(factor, Fraction) else float(number)
    converted = f"{float(times * factor):.15g}"
    if "/" in digits and (isinstance(factor, Fraction) or factor.is_integer()):
        exact = number * Fraction(factor)  # 1/480 is no decimal, and stays exact as a ratio
        converted = converted if Fraction(converted) == exact else str(exact)
    return f"; units are SI and not written, write {converted}"


def _hertz(unit: str) -> Fraction:
    return Fraction(FACTORS["Hz"][unit])


ALL_UNITS = frozenset(name for factors in FACTORS.values() for name in factors)
