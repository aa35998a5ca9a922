"""Figures from synthetic logs: what must be on the page, and what must not be imported for it."""

from __future__ import annotations

import subprocess
import sys
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib import style
from synthetic import RESIDUAL, SyntheticCell, ball_and_floor, spinning_log, trace_of

from lavendersim.errors import TraceError
from lavendersim.experiment.models.axis import Axis
from lavendersim.figures import draw
from lavendersim.figures.config_figure import compose
from lavendersim.figures.specs.catalogue import FigureSpec
from lavendersim.figures.style import DARK, STYLE
from lavendersim.measures.specs.convergence import ResidualBySweep
from lavendersim.measures.specs.impact import ImpactImpulse

MEASURES = {
    "impulse": ImpactImpulse(kind="impact_impulse", body="ball"),
    "residual": ResidualBySweep(kind="residual_by_sweep", after=0.0),
}
LABELS = {"title": "one idea", "x_label": "there [m]", "y_label": "here [N s]"}
AGAINST_AXIS = LABELS | {
    "kind": "measure_against_axis",
    "measure": "impulse",
    "axis": "speed",
    "series": "timestep",
    "series_label": "timestep {} s",
    "ideal": {
        "closed_form": {"form": "newton_impulse", "bodies": ("floor", "ball")},
        "label": "Newton",
    },
    "levels": ({"value": 4.0, "label": "four"},),
    "onsets": ({"level": 4.0, "label": "onset"},),
}
ROW = LABELS | {"kind": "row_against_index", "measure": "residual", "y_scale": "log"}
TIME = LABELS | {
    "kind": "time_series",
    "column": "normal_force",
    "body": "ball",
    "start": "first_contact",
    "window": (-0.015, 0.015),
    "factor": 0.001,
    "ideal": {"closed_form": {"form": "weight", "bodies": ("ball",)}, "label": "m g"},
}


def cells() -> list[SyntheticCell]:
    """Impacts at four speeds and two timesteps; the coarser gives a tenth more impulse."""
    made = []
    for timestep in (Fraction(1, 100), Fraction(1, 200)):
        for speed in (-1.0, -2.0, 1.0, -4.0):
            config = ball_and_floor(position=[0, 0, 0.1], velocity=[0.0, 0.0, speed])
            impulse = max(0.0, -3.0 * speed) * (1.1 if timestep == Fraction(1, 100) else 1.0)
            log = trace_of([0.0] * 6, [(3, impulse, 1e-4)], resolved=config)
            log.residual = np.array([(1, 0, 1.0), (1, 1, 0.1), (1, 2, 0.0)], RESIDUAL)
            made.append(SyntheticCell({"timestep": timestep, "speed": speed}, log))
    return made


def experiment(*panels: dict[str, Any]) -> Any:
    sweep = {"speed": Axis(path="scene.bodies.ball.velocity.2", values=(1.0,))}
    return SimpleNamespace(
        name="some_experiment",
        measures=MEASURES,
        config=SimpleNamespace(
            question="What is asked?",
            figure=FigureSpec.model_validate({"caption": "What to see.", "panels": panels}),
            overhead=None,
            sweep=sweep,
        ),
    )


def texts_of(figure: Any) -> list[str]:
    return [text.get_text() for text in figure.texts]


def legend_of(axes: Any) -> list[str]:
    return [text.get_text() for text in axes.get_legend().get_texts()]


TOP = LABELS | {"kind": "free_rotation", "body": "top", "markers": 5}


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


def test_measurements_are_markers_and_the_ideal_is_a_thin_dark_line() -> None:
    (axes,) = compose(experiment(AGAINST_AXIS), cells()).axes
    lines = {line.get_label(): line for line in axes.lines}
    coarse, fine = lines["timestep 1/100 s"], lines["timestep 1/200 s"]
    assert coarse.get_linestyle() == fine.get_linestyle() == "None"
    assert coarse.get_marker() != fine.get_marker()
    assert coarse.get_color() != fine.get_color()
    np.testing.assert_allclose(fine.get_xdata(), [-4.0, -2.0, -1.0, 1.0])
    np.testing.assert_allclose(fine.get_ydata(), [12.0, 6.0, 3.0, 0.0])
    ideal = lines["Newton"]
    assert ideal.get_color() == DARK
    assert ideal.get_linewidth() < 1.5
    assert len(ideal.get_xdata()) > 60  # between the swept values too, so the kink at 0 shows
    x, y = ideal.get_xdata(), ideal.get_ydata()
    np.testing.assert_allclose(y, np.maximum(0.0, -3.0 * x), atol=1e-12)


def test_the_spread_over_other_axes_is_a_band_around_the_mean() -> None:
    (axes,) = compose(experiment(AGAINST_AXIS | {"series": None}), cells()).axes
    (band,) = axes.collections
    heights = band.get_paths()[0].vertices[:, 1]
    assert heights.max() == pytest.approx(13.2)
    means = next(line for line in axes.lines if line.get_label() == "measured")
    assert means.get_ydata()[0] == pytest.approx(12.6)


def test_an_onset_is_marked_where_the_mean_rises_through_the_level() -> None:
    rising = AGAINST_AXIS | {"series": None, "axis": "height", "ideal": None}
    made = [SyntheticCell({"height": k}, trace_of([0.0] * 6, [(3, 2.0 * k, 0)])) for k in range(5)]
    (axes,) = compose(experiment(rising), made).axes
    assert "onset: 2.00" in legend_of(axes)


def test_a_logarithmic_axis_leaves_out_what_is_not_positive() -> None:
    (axes,) = compose(experiment(ROW), cells()).axes
    assert axes.get_yscale() == "log"
    assert np.isnan(axes.lines[0].get_ydata()).tolist() == [False, False, True]


def test_a_force_is_a_step_that_ends_at_its_time() -> None:
    (axes,) = compose(experiment(TIME), cells()[:1]).axes
    line = axes.lines[0]
    assert line.get_drawstyle() == "steps-pre"
    np.testing.assert_allclose(line.get_xdata(), [-0.01, 0.0, 0.01], atol=1e-12)
    np.testing.assert_allclose(line.get_ydata(), [0.0, 0.33, 0.0])  # 3.3 N s in 10 ms, in kN
    assert "m g" in legend_of(axes)


def test_a_number_below_the_floor_is_drawn_at_it() -> None:
    (axes,) = compose(experiment(AGAINST_AXIS | {"ideal": None, "floor": 5.0}), cells()).axes
    fine = next(line for line in axes.lines if line.get_label() == "timestep 1/200 s")
    np.testing.assert_allclose(fine.get_ydata(), [12.0, 6.0, 5.0, 5.0])


def test_drift_is_drawn_from_half_a_second_on() -> None:
    panel = LABELS | {"kind": "time_series", "column": "drift", "factor": 1000.0}
    heights = [0.3] * 50 + [0.01 * k for k in range(11)]
    (axes,) = compose(experiment(panel), [SyntheticCell({}, trace_of(heights))]).axes
    line = axes.lines[0]
    np.testing.assert_allclose(line.get_xdata(), 0.5 + 0.01 * np.arange(11), atol=1e-12)
    np.testing.assert_allclose(line.get_ydata(), 10.0 * np.arange(11), atol=1e-12)


def test_overlap_is_drawn_for_every_k_th_step_back_from_the_last() -> None:
    panel = LABELS | {"kind": "time_series", "column": "overlap", "every": 2}
    log = trace_of([-0.001, -0.002, 0.1, -0.004])
    (axes,) = compose(experiment(panel), [SyntheticCell({}, log)]).axes
    line = axes.lines[0]
    np.testing.assert_allclose(line.get_xdata(), [0.01, 0.03], atol=1e-12)
    np.testing.assert_allclose(line.get_ydata(), [0.002, 0.004], atol=1e-15)


def test_a_free_rotation_has_the_exact_solution_as_lines_and_the_log_as_markers() -> None:
    log = spinning_log()
    (axes,) = compose(experiment(TOP), [SyntheticCell({}, log)]).axes
    assert legend_of(axes) == ["Jacobi", "about x", "about y", "about z"]
    measured = [line for line in axes.lines if line.get_marker() != "None"]
    assert [len(line.get_xdata()) for line in measured] == [5, 5, 5]
    assert measured[1].get_ydata()[0] == pytest.approx(5.0)
    exact = [line for line in axes.lines if line.get_color() == DARK]
    for line, markers in zip(exact, measured, strict=True):
        # 1200 points over 20 s, between which a slope of up to 14 rad/s^2 is a straight line
        curve = np.interp(markers.get_xdata(), line.get_xdata(), line.get_ydata())
        np.testing.assert_allclose(markers.get_ydata(), curve, atol=1e-2)


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
