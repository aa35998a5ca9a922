"""Formulas: exact where numbers are, by the precedence of Python, and nothing but arithmetic."""

from __future__ import annotations

import ast
import math
import random
from fractions import Fraction

import pytest

from lavendersim.quantities.formula import FormulaError, is_formula, read_formula
from lavendersim.quantities.scalars import Ratio

NAMES = {"r": Fraction(1, 20), "n": Fraction(3), "x": 0.3}


def value(text: str) -> float:
    return read_formula(text).value(NAMES)


def test_decimals_are_calculated_exactly() -> None:
    assert value("3 * 0.1") == 0.3  # 0.30000000000000004 in floats
    assert value("2 * $r") == 0.1
    assert value("0.1 + 0.2") == 0.3


def test_a_quotient_of_whole_numbers_keeps_its_ratio() -> None:
    period = value("1 / (160 * $n)")
    assert isinstance(period, Ratio)
    assert period.fraction == Fraction(1, 480)


def test_a_whole_result_is_a_whole_number() -> None:
    assert value("2 ** $n + 1") == 9
    assert isinstance(value("2 ** $n + 1"), int)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("sqrt(2)", math.sqrt(2)),
        ("exp(2 * log($n))", 9),
        ("sin(30 * deg)", math.sin(math.pi / 6)),
        ("atan(1) * 4", math.pi),
        ("max(1, $x, 0.5) - min($x, 1)", 0.7),
        ("abs(-$n)", 3),
        ("tan($x) * cos($x) / sin($x)", math.tan(0.3) * math.cos(0.3) / math.sin(0.3)),
    ],
)
def test_functions_are_those_of_mathematics(text: str, expected: float) -> None:
    assert value(text) == pytest.approx(expected, rel=1e-15)  # some roundings of 1e-16 each


def _random_formula(draw: random.Random, depth: int) -> str:
    if depth == 0:
        return str(draw.randint(1, 9))
    kind = draw.choice(["binary", "binary", "sign", "parentheses", "power"])
    inner = _random_formula(draw, depth - 1)
    if kind == "binary":
        other = _random_formula(draw, draw.randint(0, depth - 1))
        return f"{inner} {draw.choice('+-*/')} {other}"
    if kind == "sign":
        return f"-{inner}"
    if kind == "power":
        return f"{inner} ** {draw.randint(0, 2)}"
    return f"({inner})"


class _Exact(ast.NodeTransformer):
    """Whole numbers of a Python expression, but for exponents, as Fractions."""

    def visit_Constant(self, node: ast.Constant) -> ast.AST:
        call = ast.Call(ast.Name("Fraction", ast.Load()), [node], [])
        return ast.copy_location(call, node)


def test_precedence_is_that_of_python() -> None:
    draw = random.Random(1)
    compared = 0
    for _ in range(400):
        text = _random_formula(draw, 4)
        tree = ast.fix_missing_locations(_Exact().visit(ast.parse(text, mode="eval")))
        try:
            expected = eval(compile(tree, "formula", "eval"), {"Fraction": Fraction})
        except ZeroDivisionError:
            with pytest.raises(FormulaError, match="divides by zero"):
                value(text)
            continue
        # a result of more than 512 bits is calculated in floats: some roundings of 1e-16 each
        assert value(text) == pytest.approx(float(expected), rel=1e-14), text
        compared += 1
    assert compared > 300


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("2 +", "expected a number"),
        ("2 3", "expected an operator"),
        ("sqrt 2", 'expected "\\(" behind sqrt'),
        ("sqrt(1, 2)", "takes one number"),
        ("erf(1)", "is no function"),
        ("$r.real", "expected an operator"),
        ("__import__(1)", "is no function"),
        ("1 / ($n - 3)", "divides by zero"),
        ("sqrt(0 - 1)", "no finite number"),
        ("log(0)", "no finite number"),
        ("exp(1000)", "no finite number"),
        ("(0 - 1) ** 0.5", "no real value"),
        ("9 ** 9 ** 9", "an exponent of"),
        ("10.5 ** 1000", "no finite number"),
        ("(" * 200 + "1" + ")" * 199, "nested deeper"),
        ("-" * 300 + "1", "nested deeper"),
        ("1 + " * 200 + "1", "characters, expected at most"),
    ],
)
def test_what_is_no_arithmetic_is_refused(text: str, sentence: str) -> None:
    with pytest.raises(FormulaError, match=sentence):
        value(text)


def test_the_largest_formula_takes_no_time() -> None:
    """Exact numbers stop growing at 512 bits: a chain of powers cannot fill the memory."""
    text = "(((((9 ** 99) ** 99) ** 99) ** 9) * 1)"
    with pytest.raises(FormulaError, match="no finite number"):
        value(text)


@pytest.mark.parametrize(
    "text", ["2 * $r", "$r", "-$r", "sqrt(2)", "pi", "pi / 4", "1 / 480", "2 * r"]
)
def test_texts_that_calculate_are_formulas(text: str) -> None:
    assert is_formula(text, {"r": 0})


@pytest.mark.parametrize(
    "text", ["every 4", "5 ms", "1/480 s", "ball", "ball-1", "r", "a.b.2", "12:30", "", "max", "- "]
)
def test_other_texts_are_none(text: str) -> None:
    assert not is_formula(text, {"r": 0})
