"""A time has three digits and the largest unit that it holds once."""

from __future__ import annotations

import pytest

from lavendersim.quantities.short_times import ON_PAGES, short_time


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (75.0, "75 s"),
        (1.0, "1 s"),
        (0.9994, "999 ms"),
        (1e-3, "1 ms"),
        (1234e-6, "1.23 ms"),
        (1e-6, "1 us"),
        (5.5e-8, "55 ns"),
        (0.0, "0 ns"),
    ],
)
def test_a_time_has_the_unit_that_suits_it(seconds: float, text: str) -> None:
    assert short_time(seconds) == text


def test_units_end_where_they_are_said_to() -> None:
    assert short_time(5.5e-8, ON_PAGES) == "0.055 \u00b5s"
    assert short_time(5.5e-2, ON_PAGES) == "55 ms"
