"""The printed table of overheads: units, notes and reasons stand in the row they belong to."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from lavender_cli.overheads import print_table

SPREAD = {"median": 2.04, "low": -0.3, "high": 1234.4}
ROW: dict[str, Any] = {
    "required": False,
    "why_not": "",
    "unit": "body",
    "off": {"median": 150.0},
    "on": {"median": 152.04},
    "overhead": SPREAD,
    "within_noise": True,
    "same_motion": True,
    "contacts_off": 0.0,
    "contacts_on": 3.5,
    "compile_s_off": 4.0,
    "compile_s_on": 5.25,
    "on_top_of": [],
}


def printed(capsys: pytest.CaptureFixture[str], *rows: dict[str, Any]) -> list[str]:
    table = {
        "bodies": 1,
        "contacts_per_step": 0.125,
        "steps": 960,
        "repeats": 9,
        "processor": "a processor",
        "rows": list(rows),
    }
    print_table(SimpleNamespace(results=lambda: {"overheads": table}))
    return capsys.readouterr().out.splitlines()


def test_a_row_has_its_overhead_with_unit_interval_and_compile_times(
    capsys: pytest.CaptureFixture[str],
) -> None:
    above, header, line = printed(capsys, {**ROW, "effect": "drag"})
    assert "1 movable body, 0.125 contacts a step, 960 steps; medians of 9 repeats" in above
    assert header.split()[:2] == ["effect", "required"]
    assert line.split("  ")[1:2] == ["drag"]
    words = ["no", "150.0", "152.0", "2.0 /b", "-0.3 to 1234", "4.0/5.2", "within noise"]
    places = [line.index(word) for word in words]
    assert places == sorted(places)


def test_what_else_an_overhead_depends_on_follows_it(
    capsys: pytest.CaptureFixture[str],
) -> None:
    row = {
        **ROW,
        "effect": "gravity",
        "required": True,
        "unit": "contact",
        "within_noise": False,
        "same_motion": False,
        "on_top_of": ["friction", "rotation"],
    }
    line = printed(capsys, row)[-1]
    assert "2.0 /c" in line
    assert line.endswith(
        "another motion without it: 0 and 3.5 contacts a step, on top of friction, rotation"
    )
    assert "noise" not in line


def test_a_row_without_an_overhead_says_why(capsys: pytest.CaptureFixture[str]) -> None:
    row = {"effect": "rotation", "required": True, "why_not": "friction needs it"}
    lines = printed(capsys, {**ROW, "effect": "drag"}, row)
    assert lines[-1].split() == ["rotation", "yes", "friction", "needs", "it"]


def test_a_run_without_overheads_prints_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    print_table(SimpleNamespace(results=lambda: {}))
    assert capsys.readouterr().out == ""
