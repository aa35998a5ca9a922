"""`lavender replay`: which cell is taken and where the result goes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from lavender_cli.replay import replay
from lavendersim.errors import UsageError
from lavendersim.replay import Viewpoint


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
    assert calls == [("open_viewer", "trace of e=0.1", title, None, Viewpoint())]
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
    assert [(name, at) for name, *_, at, _ in calls] == [
        ("open_viewer", 1.234),
        ("screenshot", 1.234),
    ]


def test_a_recording_that_cannot_hold_a_moment_is_refused(calls):
    result = invoke("--at", "1.234", "--save", "a.rrd")
    assert isinstance(result.exception, UsageError)
    assert calls == []


def test_a_film_shows_all_times_and_says_where_its_frames_are_without_ffmpeg(calls, monkeypatch):
    made = []
    monkeypatch.setattr(
        "lavendersim.replay.video", lambda *a: made.append(a) or a[1].with_suffix(".frames")
    )
    result = invoke("--video", "a.mp4", "--speed", "2", "--follow", "ball", "--camera", "1,2,3")
    assert made[0][3] == Viewpoint((1.0, 2.0, 3.0), "ball", 2.0)
    assert result.stdout == "a.frames\n"
    assert "ffmpeg is not installed" in result.stderr
    assert isinstance(invoke("--video", "a.mp4", "--at", "1").exception, UsageError)
    assert (len(made), calls) == (1, [])


@pytest.mark.parametrize("speed", ["0", "-1", "nan", "inf"])
def test_a_speed_that_cannot_be_is_refused(calls, speed):
    result = invoke("--speed", speed)
    assert isinstance(result.exception, UsageError)
    assert (str(result.exception), calls) == (
        f"--speed: expected a number above 0, got {speed}",
        [],
    )


@dataclass(frozen=True)
class PlacedCell:
    index: int
    label: str
    coordinates: dict[str, float]
    path: Path

    def trace(self):
        return f"{self.path.parent.parent.name} {self.label}"

    def damage(self):
        return ""


def sweep(name, values):
    folder = Path("runs") / name
    cells = tuple(
        PlacedCell(index, f"e={e}", {"e": e}, folder / "cells" / f"{index}.mcap")
        for index, e in enumerate(values)
    )
    return Run(cells, folder)


@pytest.fixture
def pairs(monkeypatch):
    """What the room is asked to show of two runs."""
    made = []
    runs = {"one": sweep("one", [0.1, 0.8]), "two": sweep("two", [0.8, 0.9])}
    monkeypatch.setattr(
        "lavendersim.runner.open_run", lambda path, root, allowed: runs[str(path)], raising=False
    )
    monkeypatch.setattr("lavendersim.replay.pair_of", lambda *a: a)
    monkeypatch.setattr("lavendersim.replay.open_viewer", lambda *a: made.append(a))
    return made


def test_of_another_run_the_cell_at_the_same_coordinates_is_shown(pairs):
    assert invoke("one", "two", "--cell", "1", "--overlay").exit_code == 0
    ((shown, title, at, _),) = pairs
    assert shown == ("one e=0.8", "two e=0.8", ("one e=0.8", "two e=0.8"), True)
    assert (title, at) == ("one e=0.8 and two e=0.8", None)


def test_another_cell_may_be_named_also_of_the_same_run(pairs):
    assert invoke("one", "one", "--cell", "0", "--other-cell", "1").exit_code == 0
    assert pairs[0][0] == ("one e=0.1", "one e=0.8", ("one e=0.1", "one e=0.8"), False)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("one", "two", "--cell", "0"), "no one cell at the coordinates of e=0.1"),
        (("one", "two", "--other-cell", "7"), "two has cells 0 to 1; there is no cell 7"),
        (("one", "--overlay"), "--overlay: name another run beside it"),
        (("one", "--other-cell", "1"), "--other-cell: name another run beside it"),
    ],
)
def test_what_has_no_partner_is_refused(pairs, arguments, sentence):
    result = invoke(*arguments)
    assert isinstance(result.exception, UsageError)
    assert sentence in str(result.exception)
    assert pairs == []
