"""Measures of measures name those they are of, in the order in which their numbers come."""

from __future__ import annotations

import pytest

from lavendersim.measures.specs.arithmetic import OPERANDS, DifferenceOf, OfRow, Power, Ratio
from lavendersim.measures.specs.base import Measure
from lavendersim.quantities.readings import SUMS
from tests.marked_config import assert_refused, config


@pytest.mark.parametrize(
    ("spec", "operands"),
    [
        (Ratio(kind="ratio", measure="a", to="b"), ("a", "b")),
        (DifferenceOf(kind="difference", measure="a", minus="b"), ("a", "b")),
        (OfRow(kind="of_row", measure="a", of="max"), ("a",)),
        (Power(kind="power", measure="a", exponent=0.5), ("a",)),
    ],
)
def test_operands_are_the_names_under_their_keys(spec: Measure, operands: tuple[str, ...]) -> None:
    assert spec.operands == operands
    named = [getattr(spec, key) for key in OPERANDS if key in type(spec).model_fields]
    assert tuple(named) == operands
    assert spec.reads({}) == SUMS  # what they are of takes what it needs


def test_an_operand_is_a_measure_of_the_file() -> None:
    a = "a: {kind: apex_error, body: ball, above: floor}"
    assert_refused(
        config(measure=f"{{{a}, r: {{kind: ratio, measure: a, to: §bb}}}}"),
        'to: no measure is called "bb"; valid here: a, r',
    )
    assert_refused(
        config(measure=f"{{{a}, r: {{kind: of_row, measure: a, of: §least}}}}"),
        "of: expected max or min or mean or sum or first or last, "
        'found the text "least"; did you mean "last"?',
    )
