"""A notebook shows what is in a log, escaped; of a cut one why, and what is left."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from lavendersim import open_trace
from lavendersim.runner import run
from lavendersim.trace.shown_log import COLUMNS, HEIGHT
from tests.drop_config import SCENE


def made(folder: Path, text: str = "") -> Path:
    (folder / "drop.yaml").write_text(f"{SCENE}duration: 1.0\n{text}")
    return run(folder / "drop.yaml", folder / "runs").run.cells[0].path


def outline(shown: str) -> list[tuple[float, float]]:
    """Return the points of the picture."""
    (points,) = re.findall(r'points="([^"]*)"', shown)
    return [tuple(map(float, point.split(","))) for point in points.split()]


def test_a_log_is_shown_with_its_steps_bodies_tables_and_energy(tmp_path: Path) -> None:
    trace = open_trace(made(tmp_path))
    shown = trace._repr_html_()
    tree = ElementTree.fromstring(shown)  # well-formed
    rows = {row[0].text: row[1].text for row in tree.iter("tr")}
    steps = len(trace.step) - 1
    assert rows["steps"] == f"{steps} of {trace.clock.timestep} s, to 1 s"
    assert rows["bodies"] == "2: floor, ball"
    assert rows['table("contact")'] == "/contacts"
    assert rows['table("velocity")'] == trace.absent["/velocities"]
    assert f"<b>{trace.path.name}</b>: complete" in shown
    # The picture is as high as the ball is fast: the largest energy is at the top, 0 at the foot.
    points = outline(shown)
    assert len(points) == 2 * min(COLUMNS, steps + 1)
    assert min(y for _, y in points) == pytest.approx(18.0, abs=0.1)
    assert max(y for _, y in points) <= HEIGHT - 2
    largest = trace.step["time"][trace.step["kinetic_energy"].argmax()]
    highest = min(points, key=lambda point: point[1])[0]
    assert highest == pytest.approx(420 * largest, abs=2 * 420 / COLUMNS)


def test_what_is_left_of_a_cut_log_is_shown_with_the_reason(tmp_path: Path) -> None:
    log = made(tmp_path)
    log.write_bytes(log.read_bytes()[:-100])
    trace = open_trace(log, allow_incomplete=True)
    shown = trace._repr_html_()
    assert trace.damage
    assert trace.status in shown
    ElementTree.fromstring(shown)


def test_names_are_escaped(tmp_path: Path) -> None:
    log = made(tmp_path).rename(tmp_path / "<b>&.mcap")
    shown = open_trace(log)._repr_html_()
    assert "&lt;b&gt;&amp;.mcap" in shown
    ElementTree.fromstring(shown)
