"""The figures of `lavender solve`: what was achieved is drawn, and what was not is not left out."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib import style
from matplotlib.figure import Figure

from lavendersim.figures import draw_comparisons, residual_against_time
from lavendersim.figures.residual_against_time import HIGHEST, marks
from lavendersim.figures.style import STYLE

SOLVERS = [f"solver_{number}" for number in range(10)]
CURVE = ((1e-4, 0.5), (2e-4, 1e-3), (8e-4, 1e-9))


def attempt(solver: str, points: tuple = CURVE) -> Any:
    """What a solver made of a problem; `points` are (seconds, scaled)."""
    drawn = [SimpleNamespace(seconds=s, scaled=r, repeats=n) for n, (s, r) in enumerate(points, 2)]
    return SimpleNamespace(solver=solver, points=drawn, timing=SimpleNamespace(repeats=7))


def problem(name: str, *attempts: Any, contacts: int = 5) -> Any:
    return SimpleNamespace(name=name, contacts=contacts, attempts=attempts, truth="")


def page(*problems: Any) -> Figure:
    with style.context(STYLE, after_reset=True):
        return residual_against_time.compose(problems, 1e-8, "A processor")


def texts(figure: Figure) -> str:
    return " ".join(" ".join(text.get_text().split()) for text in figure.texts)


def test_every_point_is_drawn_where_it_was_measured() -> None:
    figure = page(problem("pile.hdf5.dat", attempt("fast"), attempt("slow", ((0.1, 1e-3),))))
    (axes,) = figure.axes
    drawn = [line.get_xydata() for line in axes.lines]
    expected = np.array([(1e3 * seconds, scaled) for seconds, scaled in CURVE])
    assert any(len(one) == 3 and np.allclose(one, expected, rtol=1e-12) for one in drawn)
    assert any(len(one) == 1 and np.allclose(one, [[100.0, 1e-3]]) for one in drawn)
    assert axes.get_title(loc="left") == "pile, 5 contacts"
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time [ms]", "scaled residual [-]")
    low, high = axes.get_xlim()
    assert low < 0.1
    assert high > 100.0


@pytest.mark.parametrize("bad", [np.inf, np.nan, 1e30])
def test_what_runs_away_is_marked_at_the_top_and_explained(bad: float) -> None:
    figure = page(problem("p.dat", attempt("wild", ((1e-3, 0.1), (2e-3, bad)))))
    (axes,) = figure.axes
    hollow = [line for line in axes.lines if line.get_markerfacecolor() == "white"]
    assert [tuple(place) for line in hollow for place in line.get_xydata()] == [(2.0, HIGHEST)]
    assert "Hollow: not finite" in texts(figure)
    assert "Hollow" not in texts(page(problem("p.dat", attempt("tame"))))


def test_the_caption_says_machine_repeats_and_tolerance() -> None:
    said = texts(page(problem("p.dat", attempt("one"))))
    for part in ("A processor", "2 to 4 repeats", "the tolerance 1e-08", "without compilation"):
        assert part in said


def test_no_two_of_many_solvers_look_alike() -> None:
    looks = [
        (drawn["color"], drawn["marker"], drawn["linestyle"])
        for drawn in (marks(SOLVERS, name) for name in SOLVERS)
    ]
    assert len(set(looks)) == len(SOLVERS)


def test_the_legend_covers_no_panel_and_no_text_another() -> None:
    names = [f"accelerated_projected_gradient_{number}" for number in range(9)]
    problems = [problem(f"p{k}.dat", *map(attempt, names)) for k in range(4)]
    figure = page(*problems)
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    legend = figure.legends[0].get_window_extent(renderer)
    panels = [axes.get_tightbbox(renderer) for axes in figure.axes if axes.axison]
    assert len(panels) == 4
    assert not any(legend.overlaps(panel) for panel in panels)
    caption = figure.texts[0].get_window_extent(renderer)
    assert not any(caption.overlaps(panel) for panel in panels)
    assert not any(a.overlaps(b) for k, a in enumerate(panels) for b in panels[:k])
    assert legend.x1 <= figure.bbox.x1


def test_more_problems_than_a_page_holds_go_on_the_next(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(residual_against_time, "PANELS_ON_PAGE", 2)
    many = [problem(f"p{k}.dat", attempt("one")) for k in range(3)]
    ratios = {"one": [1.0] * len(many)}
    paths = draw_comparisons(many, ratios, 1e-8, "A processor", tmp_path)
    names = [path.name for path in paths]
    assert names[::2] == [
        *("residual_against_time_1.png", "residual_against_time_2.png"),
        "performance_profile.png",
    ]
    assert all(path.is_file() for path in paths)


def test_equal_numbers_draw_equal_files(tmp_path: Path) -> None:
    one = problem("p.dat", attempt("one"))
    drawn = [
        draw_comparisons([one], {"one": [1.0]}, 1e-8, "A processor", tmp_path / name)
        for name in "ab"
    ]
    assert [path.read_bytes() for path in drawn[0]] == [path.read_bytes() for path in drawn[1]]
