"""Kinds of panels from other distributions: read, drawn, or refused where they cannot be."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.drop_config import DROP

PANEL = '''
from typing import Literal

from lavendersim.figures.registration import draws
from lavendersim.figures.specs.base import Panel


class CellCount(Panel):
    """How many cells a panel shows."""

    kind: Literal["cell_count"]


@draws(CellCount)
def draw_count(axes, panel, cells, values, experiment):
    axes.text(0.5, 0.5, f"{len(cells)} cells")
'''
FIGURE = """\
figure:
  caption: What to see.
  panels:
    - {kind: cell_count, title: how many, x_label: "x [-]", y_label: "y [-]"}
"""
DRAWN = """
import sys
from lavendersim.experiment import load_experiment_text
from lavendersim.figures.config_figure import compose
experiment = load_experiment_text(sys.stdin.read(), "drop.yaml")
(axes,) = compose(experiment, []).axes
print(axes.get_title(loc="left"), [text.get_text() for text in axes.texts])
"""


def drawn_with(folder: Path, source: str) -> subprocess.CompletedProcess[str]:
    """Draw a config's figure beside a distribution whose module `counted` has this source."""
    about = folder / "counted-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: counted\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text("[lavendersim.figures]\ncount = counted\n")
    (folder / "counted.py").write_text(source)
    return subprocess.run(
        [sys.executable, "-c", DRAWN],
        input=DROP + FIGURE,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": str(folder)},
    )


def test_a_panel_of_another_distribution_is_read_and_drawn(tmp_path: Path) -> None:
    done = drawn_with(tmp_path, PANEL)
    assert done.stdout == "how many ['0 cells']\n", done.stderr


@pytest.mark.parametrize(
    ("source", "sentence"),
    [
        (
            PANEL.replace("cell_count", "time_series"),
            "lavendersim.figures: counted of the distribution counted: there is a 'time_series' "
            "already",
        ),
        (
            "import nothing_of_this_name",
            "lavendersim.figures: counted of the distribution counted cannot be imported: No "
            "module named 'nothing_of_this_name'",
        ),
    ],
)
def test_one_that_cannot_be_is_refused_in_a_sentence(
    source: str, sentence: str, tmp_path: Path
) -> None:
    done = drawn_with(tmp_path, source)
    assert done.stderr.splitlines()[-1] == f"lavendersim.errors.UsageError: {sentence}"
