"""Rerun's own MCAP importer finds moving geometry, contact points and plots in a log."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from sample import run, write


def rerun(*arguments: str | Path) -> str:
    command = [sys.executable, "-m", "rerun", *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True, timeout=60).stdout


@pytest.fixture(scope="module")
def chunks(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Entity -> all columns that rerun made for it."""
    folder = tmp_path_factory.mktemp("rerun")
    log = write(folder / "run.mcap", [run(50)])
    rerun("mcap", "convert", log, "-o", folder / "run.rrd")
    found: dict[str, str] = {}
    listed = rerun("rrd", "print", folder / "run.rrd")
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
