"""An ideal is a closed form or a value, and a value a number or a formula."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import ValidationError

from lavendersim.figures.specs.ideal import Ideal
from lavendersim.measures.specs.base import ClosedForm

WEIGHT = ClosedForm(form="weight", bodies=("ball",))


@pytest.mark.parametrize("value", [0.25, "2 * $length"])
def test_a_value_is_a_number_or_a_formula_that_takes_axes(value: float | str) -> None:
    assert Ideal(value=value, label="law").value == value


@pytest.mark.parametrize("given", [{}, {"value": 1.0, "closed_form": WEIGHT}])
def test_an_ideal_is_one_of_the_two(given: dict[str, Any]) -> None:
    with pytest.raises(ValidationError, match="exactly one of value, closed_form"):
        Ideal(label="law", **given)


def test_a_text_that_is_no_formula_is_refused() -> None:
    with pytest.raises(ValidationError, match="a number or a formula"):
        Ideal(value="about two", label="law")
