"""The printed table of overheads: units, notes and reasons stand in the row they belong to."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from lavender_cli.overheads import print_table
from tests.made_costs import spread
from tests.made_overheads import gap, overhead_table, timed

COSTS: dict[str, Any] = {
    "off": spread(150.0, 149.0, 151.0),
    "on": spread(152.04, 151.0, 153.0),
    "overhead": spread(2.04, -0.3, 1234.4),
    "within_noise": True,
    "contacts_on": 3.5,
    "compile_s_off": 4.0,
    "compile_s_on": 5.25,
}


def printed(capsys: pytest.CaptureFixture[str], *rows: dict[str, Any]) -> list[str]:
    table = overhead_table(*rows, contacts_per_step=0.125)
    print_table(SimpleNamespace(overheads=lambda: table))
    return capsys.readouterr().out.splitlines()


def test_a_row_has_its_overhead_with_unit_interval_and_compile_times(
    capsys: pytest.CaptureFixture[str],
) -> None:
    above, header, line = printed(capsys, timed("drag", 2.04) | COSTS)
    assert "1 movable body, 0.125 contacts a step, 960 steps; medians of 9 repeats" in above
    assert header.split()[:2] == ["effect", "required"]
    assert line.split("  ")[1:2] == ["drag"]
    words = ["no", "150.0", "152.0", "2.0 /b", "-0.3 to 1234", "4.0/5.2", "within noise"]
    places = [line.index(word) for word in words]
    assert places == sorted(places)


def test_what_else_an_overhead_depends_on_follows_it(
    capsys: pytest.CaptureFixture[str],
) -> None:
    another = {"required": True, "unit": "contact", "within_noise": False, "same_motion": False}
    row = timed("gravity", 2.04, on_top_of=["friction", "rotation"]) | COSTS | another
    line = printed(capsys, row)[-1]
    assert "2.0 /c" in line
    assert line.endswith(
        "another motion without it: 0 and 3.5 contacts a step, on top of friction, rotation"
    )
    assert "noise" not in line


def test_a_row_without_an_overhead_says_why(capsys: pytest.CaptureFixture[str]) -> None:
    row = gap("rotation", "friction needs it")
    lines = printed(capsys, timed("drag", 2.04) | COSTS, row)
    assert lines[-1].split() == ["rotation", "yes", "friction", "needs", "it"]


def test_a_run_without_overheads_prints_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    print_table(SimpleNamespace(overheads=lambda: None))
    assert capsys.readouterr().out == ""
