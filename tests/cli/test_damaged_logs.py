"""A verb that meets a damaged log says so, exits 3, and draws nothing unless it is asked to."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from damaged_runs import DRAWN, copied, cut, flip, logs, made, verb

from lavendersim import open_run
from lavendersim.errors import TraceError


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished run of two cells, with its figure."""
    return made(DRAWN, tmp_path_factory.mktemp("whole"))


@pytest.fixture
def spoilt(whole: Path, tmp_path: Path) -> Path:
    """The same run, of which one log was cut."""
    run = copied(whole, tmp_path)
    cut(logs(run)[1], 0.7)
    return run


def files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_whole_logs_are_drawn_and_listed_without_a_word(whole: Path, tmp_path: Path) -> None:
    done = verb("plot", whole, "-o", tmp_path)
    assert (done.code, done.stderr) == (0, "")
    assert files(tmp_path) == files(whole / "figures")
    assert "INCOMPLETE" not in done.stdout
    for arguments in (("show", whole), ("ls", "--runs", whole.parent)):
        assert verb(*arguments).code == 0


def test_a_cut_log_is_not_drawn_and_the_earlier_figure_stays(spoilt: Path) -> None:
    before = files(spoilt / "figures")
    done = verb("plot", spoilt)
    assert (done.code, done.stdout) == (3, "")
    sentence, refusal = done.stderr.splitlines()
    assert sentence.startswith(f"{logs(spoilt)[1]}: unfinished, its end is missing")
    assert refusal.startswith("nothing is drawn; --allow-incomplete")
    assert files(spoilt / "figures") == before


def test_no_run_is_drawn_where_one_of_several_is_damaged(
    whole: Path, spoilt: Path, tmp_path: Path
) -> None:
    done = verb("plot", whole, spoilt, "-o", tmp_path / "figures")
    assert (done.code, done.stdout) == (3, "")
    assert not (tmp_path / "figures").exists()


def test_a_cut_log_is_drawn_on_request_and_the_figure_says_so(spoilt: Path) -> None:
    from matplotlib import style

    from lavendersim.figures.config_figure import compose
    from lavendersim.figures.style import STYLE

    before = files(spoilt / "figures")
    done = verb("plot", spoilt, "--allow-incomplete")
    assert done.code == 3
    assert "unfinished" in done.stderr
    assert files(spoilt / "figures") != before
    run = open_run(spoilt, allow_incomplete=True)
    with style.context(STYLE, after_reset=True):
        figure = compose(run.experiment, run.cells)
    caption = " ".join(" ".join(text.get_text() for text in figure.texts).split())
    assert "INCOMPLETE: the logs of 1 of 2 cells are damaged" in caption
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert sum(label.endswith(" (incomplete)") for label in labels) == 1


def test_one_bit_in_a_chunk_that_the_figure_does_not_read_refuses_it(
    whole: Path, tmp_path: Path
) -> None:
    run = copied(whole, tmp_path)
    flip(logs(run)[0], logs(run)[0].stat().st_size // 3)
    done = verb("plot", run)
    assert done.code == 3
    assert "damaged" in done.stderr


def test_a_log_that_is_not_there_refuses_the_figure(whole: Path, tmp_path: Path) -> None:
    run = copied(whole, tmp_path)
    logs(run)[0].unlink()
    done = verb("plot", run)
    assert done.code == 3
    assert done.stderr.startswith(f"{run / 'cells' / logs(whole)[0].name}: no such log\n")


def test_a_cut_log_is_not_replayed_and_on_request_its_title_says_so(
    spoilt: Path, tmp_path: Path
) -> None:
    cells = open_run(spoilt).cells
    (place,) = (cell.index for cell in cells if cell.path == logs(spoilt)[1])
    out = tmp_path / "view.rrd"
    done = verb("replay", spoilt, "--cell", place, "--save", out)
    assert (done.code, done.stdout) == (3, "")
    assert not out.exists()
    assert verb("replay", spoilt, "--cell", 1 - place, "--save", out).code == 0


def test_show_and_ls_say_which_log_was_cut(spoilt: Path) -> None:
    shown = verb("show", spoilt)
    assert shown.code == 3
    assert "rebound" in shown.stdout  # results are read from their table
    assert shown.stderr.count("unfinished") == 1
    assert verb("show", spoilt, "--json").code == 3
    listed = verb("ls", "--runs", spoilt.parent)
    assert listed.code == 3
    assert listed.stdout.startswith("CUT   ")
    assert listed.stderr.count("unfinished") == 1
    (row,) = json.loads(verb("ls", "--runs", spoilt.parent, "--json").stdout)
    assert len(row["damaged"]) == 1


def test_a_cell_of_the_python_interface_is_refused_unless_allowed(spoilt: Path) -> None:
    cut_log = logs(spoilt)[1]
    (cell,) = (cell for cell in open_run(spoilt).cells if cell.path == cut_log)
    with pytest.raises(TraceError, match="unfinished"):
        cell.trace()
    (cell,) = (c for c in open_run(spoilt, allow_incomplete=True).cells if c.path == cut_log)
    assert cell.damage()


def test_a_diverged_run_has_whole_logs(tmp_path: Path) -> None:
    falls = DRAWN.replace("scene:\n", "scene:\n  gravity: [0, 0, -9.81]\n", 1)
    falls = falls.replace("scene.bodies.ball.surface.restitution", "scene.gravity.2")
    run = made(falls.replace("[0.5, 0.52]", "[-9.81, 1e155]"), tmp_path)
    ended = [cell.trace().status for cell in open_run(run).cells]
    assert ended[0] == "complete"
    assert ended[1].startswith("diverged: ")
    done = verb("plot", run)
    assert (done.code, done.stderr) == (0, "")
    assert verb("show", run).code == 0


def test_a_report_says_of_a_log_that_it_was_cut(tmp_path: Path) -> None:
    from lavendersim.experiment import load_experiment
    from lavendersim.figures import write_report
    from lavendersim.runner import run

    (tmp_path / "drop.yaml").write_text(DRAWN)
    finished = run(load_experiment(tmp_path / "drop.yaml"), tmp_path / "runs")
    assert write_report([finished], tmp_path / "report.html") == []
    for log in logs(finished.run.path):
        cut(log, 0.5)
    damaged = write_report([finished], tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text()
    assert len(damaged) == 2
    assert page.count("unfinished, its end is missing") >= 2
