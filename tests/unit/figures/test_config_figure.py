"""Figures from synthetic logs: what must be on the page, and what must not be imported for it."""

from __future__ import annotations

import subprocess
import sys
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from made_impacts import AGAINST_AXIS, ROW, TIME, cells, experiment, legend_of
from matplotlib import style
from synthetic import SyntheticCell

from lavendersim.errors import TraceError
from lavendersim.figures import draw
from lavendersim.figures.config_figure import compose
from lavendersim.figures.style import STYLE


def texts_of(figure: Any) -> list[str]:
    return [text.get_text() for text in figure.texts]


@pytest.mark.parametrize("panel", [AGAINST_AXIS, ROW, TIME], ids=lambda panel: panel["kind"])
def test_a_panel_has_title_labels_with_units_and_a_legend(panel: dict[str, Any]) -> None:
    figure = compose(experiment(panel), cells())
    (axes,) = figure.axes
    assert axes.get_title(loc="left") == "one idea"
    assert axes.get_xlabel() == "there [m]"
    assert axes.get_ylabel() == "here [N s]"
    assert legend_of(axes)


def test_question_and_caption_are_on_the_page() -> None:
    assert texts_of(compose(experiment(ROW), cells())) == ["What is asked?", "What to see."]


def test_cells_without_a_log_are_counted_in_the_caption() -> None:
    broken = SyntheticCell({"timestep": Fraction(1, 100), "speed": -9.0}, TraceError("cut short"))
    texts = " ".join(texts_of(compose(experiment(ROW), [*cells(), broken])))
    assert "1 of 9 cells have no readable log" in " ".join(texts.split())


def test_files_are_png_and_svg_and_equal_logs_give_equal_bytes(tmp_path: Path) -> None:
    run = SimpleNamespace(
        experiment=experiment(AGAINST_AXIS, ROW, TIME), cells=cells(), name="drop"
    )
    first = draw(run, tmp_path / "a")
    second = draw(run, tmp_path / "b")
    assert [path.name for path in first] == ["drop.png", "drop.svg"]
    for one, other in zip(first, second, strict=True):
        assert one.read_bytes() == other.read_bytes()


def test_an_experiment_without_a_figure_draws_nothing(tmp_path: Path) -> None:
    run = SimpleNamespace(
        experiment=SimpleNamespace(config=SimpleNamespace(figure=None, overhead=None), name="x"),
        cells=[],
    )
    assert draw(run, tmp_path) == []
    assert not list(tmp_path.iterdir())


def test_the_text_stays_inside_the_page() -> None:
    made = experiment(ROW)
    made.config.question = "Which of these many words will illuminate millimetres? " * 20
    with style.context(STYLE, after_reset=True):
        figure = compose(made, cells())
        figure.canvas.draw()
    page = figure.bbox
    for text in figure.texts:
        box = text.get_window_extent()
        assert page.x0 <= box.x0 < box.x1 <= page.x1
        assert page.y0 <= box.y0 < box.y1 <= page.y1


@pytest.mark.parametrize(
    ("module", "absent"),
    [
        (
            "lavendersim.figures.config_figure",
            ("numba", "rerun", "matplotlib.pyplot", "lavendersim.engine.engine"),
        ),
        ("lavendersim.measures", ("numba", "rerun", "matplotlib", "lavendersim.engine.engine")),
        ("lavendersim.figures", ("numba", "rerun", "matplotlib")),
    ],
)
def test_imports_stay_light(module: str, absent: tuple[str, ...]) -> None:
    program = f"import sys, {module}; print([name for name in {absent} if name in sys.modules])"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"
