"""`lavender run --plot`: figures are drawn beside the runs that follow, and reported in order."""

from __future__ import annotations

import json
from pathlib import Path

from command_line import lavender

from tests.drop_config import DROP

FIGURE = """\
sweep:
  e: {path: scene.bodies.ball.surface.restitution, values: [0.4, 0.5]}
figure:
  caption: Heights by e.
  panels:
    - kind: measure_against_axis
      title: Rebound
      axis: e
      measure: rebound
      x_label: e
      y_label: height [m]
"""
NAMES = ("first", "second", "third")


def write(folder: Path) -> None:
    """Write three experiments; only the second one has no figure."""
    drop = DROP.replace("between: [0.02, 0.03]", "between: [0.01, 0.03]")
    for name in NAMES:
        text = drop if name == "second" else drop + FIGURE
        (folder / f"{name}.yaml").write_text(text.replace("expected: e^2 h.\n", ""))


def test_figures_are_reported_with_their_runs_and_are_those_of_plot(tmp_path: Path) -> None:
    write(tmp_path)
    configs = [f"{name}.yaml" for name in NAMES]
    done = lavender("run", *configs, "--plot", where=tmp_path)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    # Of each experiment its name opens a line, and its figures end what is said of it.
    said = [line.split(":")[0] for line in lines if line.startswith(NAMES)]
    assert said == list(NAMES)
    figures = [Path(line.split()[1]) for line in lines if line.startswith("  figure ")]
    assert [path.name for path in figures] == [
        *("first.png", "first.svg", "third.png", "third.svg")
    ]
    order = [line.split()[0].strip(":") for line in lines if line.startswith((*NAMES, "  figure"))]
    assert order == ["first", "figure", "figure", "second", "third", "figure", "figure"]
    for path in figures[::2]:
        again = lavender("plot", path.parent.parent, "-o", "again", where=tmp_path)
        assert again.returncode == 0, again.stderr
        for one in (path, path.with_suffix(".svg")):
            assert (tmp_path / one).read_bytes() == (tmp_path / "again" / one.name).read_bytes()


def test_figures_of_a_run_that_is_finished_are_drawn_where_it_goes_on(tmp_path: Path) -> None:
    """As where a signal came while they were drawn: the command that goes on draws them."""
    write(tmp_path)
    assert lavender("run", "first.yaml", where=tmp_path).returncode == 0
    for more in ((), ("--json",)):
        done = lavender("run", "first.yaml", "--resume", "--plot", *more, where=tmp_path)
        assert done.returncode == 0, done.stderr
        assert "finished, nothing to resume" in done.stderr
        assert len([*(tmp_path / "runs").glob("2*")]) == 1
        drawn = json.loads(done.stdout)[0]["figures"] if more else done.stdout.split()[1::2]
        assert [Path(path).name for path in drawn] == ["first.png", "first.svg"]
    assert lavender("plot", "-o", "again", where=tmp_path).returncode == 0
    for path in (tmp_path / "again").iterdir():
        assert (tmp_path / "runs/latest/figures" / path.name).read_bytes() == path.read_bytes()


def test_json_has_the_figures_of_each_run(tmp_path: Path) -> None:
    write(tmp_path)
    done = lavender("run", *(f"{n}.yaml" for n in NAMES), "--plot", "--json", where=tmp_path)
    assert done.returncode == 0, done.stderr
    figures = [[Path(path).name for path in one["figures"]] for one in json.loads(done.stdout)]
    assert figures == [["first.png", "first.svg"], [], ["third.png", "third.svg"]]
