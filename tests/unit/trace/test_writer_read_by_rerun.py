"""Rerun's own MCAP importer finds moving geometry, contact points and plots in a log."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from sample import run, write

from lavendersim.trace.layout import CHANNELS


def rerun(*arguments: str | Path) -> str:
    command = [sys.executable, "-m", "rerun", *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True, timeout=60).stdout


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A log whose groups have several chunks of contacts: 50 steps of some 40 kB."""
    return write(tmp_path_factory.mktemp("rerun") / "run.mcap", [run(50, contacts=400)])


@pytest.fixture(scope="module")
def chunks(log: Path) -> dict[str, str]:
    """Entity -> all columns that rerun made for it."""
    converted = log.with_suffix(".rrd")
    rerun("mcap", "convert", log, "-o", converted)
    found: dict[str, str] = {}
    listed = rerun("rrd", "print", converted)
    for entity, columns in re.findall(r" - (/\S+) - data columns: \[(.*)\]", listed):
        found[entity] = found.get(entity, "") + columns + " "
    return found


@pytest.mark.parametrize(
    ("entity", "component"),
    [
        ("/tf", "Transform3D:translation"),
        ("/contacts", "Points3D:positions"),
        ("/contacts", "Points3D:colors"),
        ("/plot/force", "Scalars:scalars"),
        ("/plot/penetration", "Scalars:scalars"),
        ("/plot/log10_residual", "Scalars:scalars"),
        ("/step", "lavender.Step:message"),
        ("/scene/visual_geometries/floor/floor", "Boxes3D:half_sizes"),
        ("/scene/visual_geometries/ball/ball", "Ellipsoids3D:half_sizes"),
        ("/scene/visual_geometries/crate/crate", "Boxes3D:half_sizes"),
    ],
)
def test_rerun_finds(chunks: dict[str, str], entity: str, component: str) -> None:
    assert component in chunks[entity].split()


def test_rerun_checks_the_log_without_an_issue(log: Path) -> None:
    """Its own check: chunks in order on every timeline, topics without conflicts."""
    listed = re.findall(
        r"^(\w+) +\d+ +\d+ +(/\S+) +(.+)$", rerun("mcap", "check", "--full", log), re.M
    )
    written = CHANNELS.keys() - {"/velocities"}  # of a log whose config says nothing of them
    assert len(listed) == len(written)
    assert {topic for _, topic, _ in listed} == written
    assert {(status, issue.strip()) for status, _, issue in listed} == {("ok", "—")}
