"""Columns of a table: the unit of a meaning, and names that are taken."""

from __future__ import annotations

from lavendersim.arrow.fields import Field, described, distinct


def test_a_unit_in_brackets_is_the_columns() -> None:
    assert described("gap", "f8", "signed distance [m]") == Field(
        "gap", "f8", "signed distance", "m"
    )
    middle = described("v", "f8", "speed [m/s] along the normal")
    assert (middle.meaning, middle.unit) == ("speed along the normal", "m/s")


def test_a_ratio_has_a_dash_and_a_name_has_no_unit() -> None:
    assert described("mu", "f8", "friction [-]").unit == "-"
    assert described("body", "word", "which body", ("a", "b")) == Field(
        "body", "word", "which body", "", ("a", "b")
    )


def test_a_name_that_is_taken_gets_its_group_before_it() -> None:
    own = [Field("status", "text"), Field("cell", "i8")]
    swept = [Field("status", "f8"), Field("e", "f8")]
    measured = [Field("sweep_status", "f8"), Field("status", "f8")]
    names = [one.name for one in distinct({"": own, "sweep": swept, "measure": measured})]
    assert names == [
        *("status", "cell", "sweep_status", "e", "measure_sweep_status", "measure_status"),
    ]
    assert len(set(names)) == len(names)
