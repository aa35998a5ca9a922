"""A verdict says what was measured, what was expected, and where; a table has that as one text."""

from __future__ import annotations

from lavendersim.measures.verdict import Verdict

NUMBERS = "rebound at e=0.8", False, 0.5, "at most 0.4", "none"


def test_the_message_has_every_part_of_the_verdict() -> None:
    one = Verdict("rebound", *NUMBERS, "", "a.mcap", measure="height", reason="too high")
    assert one.message.splitlines() == [
        "rebound at e=0.8: FAILED",
        "  measured   0.5 (height)",
        "  expected   at most 0.4",
        "  tolerance  none",
        "  because    too high",
        "  log        a.mcap",
    ]


def test_what_there_is_not_is_left_out() -> None:
    assert Verdict("rebound", *NUMBERS, "", "").message.splitlines() == [
        "rebound at e=0.8: FAILED",
        "  measured   0.5",
        "  expected   at most 0.4",
        "  tolerance  none",
    ]


def test_a_message_that_is_not_of_the_numbers_alone_is_as_it_was_given() -> None:
    assert Verdict("a control", *NUMBERS, "it did not fail", "a.mcap").message == "it did not fail"


def test_a_row_of_a_table_has_the_message_in_place_of_its_parts() -> None:
    one = Verdict("rebound", *NUMBERS, "", "a.mcap", measure="height", reason="too high")
    assert one.row["message"] == one.message
    assert list(one.row) == [
        *("name", "node", "passed", "measured", "expected", "tolerance", "message"),
        *("path", "follows", "margin"),
    ]
