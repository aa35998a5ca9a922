"""`lavender replay`: which cell is taken and where the result goes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from lavender_cli.replay import replay
from lavendersim.errors import UsageError


@dataclass
class Cell:
    label: str

    def trace(self):
        return f"trace of {self.label}"

    def damage(self):
        return ""


@dataclass
class Run:
    cells: tuple[Cell, ...]
    path: Path = Path("runs/20260101T000000Z-drop-0123abcd")


@pytest.fixture
def calls(monkeypatch):
    """What the room was asked for, in order; the room itself stays out of it."""
    made = []
    sweep = Run((Cell("e=0.1"), Cell("e=0.8")))
    monkeypatch.setattr(
        "lavendersim.runner.open_run", lambda path, root, allowed: sweep, raising=False
    )
    for name in ("open_viewer", "save"):
        monkeypatch.setattr(f"lavendersim.replay.{name}", lambda *a, n=name: made.append((n, *a)))
    shoot = lambda *a: made.append(("screenshot", *a)) or ["warning: too dark"]  # noqa: E731
    monkeypatch.setattr("lavendersim.replay.screenshot", shoot)
    return made


def invoke(*arguments):
    app = typer.Typer()
    app.command()(replay)
    return CliRunner().invoke(app, arguments)


def test_without_options_the_first_cell_opens_and_the_others_are_named(calls):
    result = invoke()
    title = "20260101T000000Z-drop-0123abcd e=0.1"
    assert calls == [("open_viewer", "trace of e=0.1", title, None)]
    assert "--cell K" in result.stderr
    assert result.stdout == ""


def test_save_and_screenshot_open_nothing_and_print_their_paths(calls):
    result = invoke("--cell", "1", "--save", "a.rrd", "--screenshot", "a.png")
    assert [(name, trace, str(path)) for name, trace, path, *_ in calls] == [
        ("save", "trace of e=0.8", "a.rrd"),
        ("screenshot", "trace of e=0.8", "a.png"),
    ]
    assert result.stdout == "a.rrd\na.png\n"
    assert result.stderr == "rerun's viewer: warning: too dark\n"


@pytest.mark.parametrize("cell", ["2", "-1"])
def test_cell_that_does_not_exist_is_refused_with_the_range(calls, cell):
    result = invoke("--cell", cell)
    assert isinstance(result.exception, UsageError)
    assert "cells 0 to 1" in str(result.exception)
    assert calls == []


def test_a_moment_is_given_to_the_window_and_to_the_picture(calls):
    invoke("--cell", "1", "--at", "1.234")
    invoke("--cell", "1", "--at", "1.234", "--screenshot", "a.png")
    assert [(name, at) for name, *_, at in calls] == [("open_viewer", 1.234), ("screenshot", 1.234)]


def test_a_recording_that_cannot_hold_a_moment_is_refused(calls):
    result = invoke("--at", "1.234", "--save", "a.rrd")
    assert isinstance(result.exception, UsageError)
    assert calls == []
