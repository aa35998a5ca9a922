"""`lavender cost`: a table and sentences on stdout, or what is to be pasted and nothing else."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command_line import lavender

from lavendersim import open_run
from lavendersim.experiment import load_experiment

COST = """\
cost:
  error: {measure: rebound, truth: 0.025}
  solvers: [projected_gauss_seidel]
  timesteps: [1/240]
  sweeps: [4]
  warm_start: [true]
  repeats: 7
"""


@pytest.fixture
def costed(drop: Path) -> Path:
    drop.write_text(drop.read_text() + COST)
    return drop


def test_a_grid_gives_a_table_a_figure_and_a_sentence_a_target(
    costed: Path, tmp_path: Path
) -> None:
    done = lavender("cost", costed, where=tmp_path)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert "medians of 7 interleaved repeats" in lines[0]
    rows = [line for line in lines if "projected_gauss_seidel" in line and "240 Hz" in line]
    assert any("specified" in line and "22 sweeps" in line for line in rows)
    assert any("4 sweeps" in line for line in rows)
    assert any(line.startswith("1 % costs") or "reaches 1 %" in line for line in lines)
    assert any(line.startswith("0.1 % costs") or "reaches 0.1 %" in line for line in lines)
    figures = sorted((tmp_path / "runs" / "latest" / "figures").iterdir())
    assert [path.name for path in figures] == ["drop_cost.png", "drop_cost.svg"]
    plotted = lavender("plot", where=tmp_path)
    assert plotted.returncode == 0, plotted.stderr
    assert "drop_cost.png" in plotted.stdout


def test_what_is_set_stands_in_every_setting_of_the_grid(costed: Path, tmp_path: Path) -> None:
    asked = ("--set", "duration=0.4", "--sweep", "e=scene.bodies.ball.surface.restitution:[0.5]")
    done = lavender("cost", costed, *asked, "--no-plot", "--json", where=tmp_path)
    assert done.returncode == 0, done.stderr
    (table,) = json.loads(done.stdout)
    assert table["duration"] == 0.4
    assert "e" in table["axes"]
    named = Path(table["run"]).name
    assert "-drop-duration=0.4-e=" in named  # as the directory of `run --set` is
    run = open_run(Path(table["run"]) if Path(table["run"]).exists() else tmp_path / table["run"])
    bodies = [cell.config.scene.bodies["ball"] for cell in run.experiment.cells()]
    assert {one.surface.restitution for one in bodies} == {0.5}
    wrong = lavender("cost", costed, "--set", "duratoin=1", "--no-plot", where=tmp_path)
    assert wrong.returncode == 2
    assert wrong.stderr.startswith("--set duratoin=1:1:7: path: ")


def test_a_target_prints_what_is_to_be_pasted_and_nothing_else(
    costed: Path, tmp_path: Path
) -> None:
    done = lavender("cost", costed, "--target", "50%", "--no-plot", where=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("numerics: ")
    assert done.stdout.count("\n") == 1
    assert "50 % costs" in done.stderr
    costed.write_text(costed.read_text().replace("numerics: chapter\n", done.stdout))
    assert load_experiment(costed).cells()
    missed = lavender("cost", costed, "--target", "1e-9%", "--no-plot", where=tmp_path)
    assert missed.returncode == 1
    assert missed.stdout == ""
    assert "no setting of the grid reaches 1e-09 %: the nearest is " in missed.stderr
    assert not (tmp_path / "runs" / "latest" / "figures").exists()


def test_in_a_folder_those_with_a_section_are_meant(drop: Path, tmp_path: Path) -> None:
    folder = tmp_path / "configs"
    folder.mkdir()
    drop.rename(folder / "drop.yaml")
    done = lavender("cost", folder, where=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"{folder}: no config in this folder has a section cost\n"
    costed = (folder / "drop.yaml").read_text() + COST
    (folder / "costed.yaml").write_text(costed)
    done = lavender("cost", folder, "--target", "50%", "--no-plot", where=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("\n") == 1
    assert "costed: " in done.stderr
    assert "drop: " not in done.stderr


def test_json_has_every_sample_and_the_answers(costed: Path, tmp_path: Path) -> None:
    done = lavender(
        "cost", costed, "--json", "--no-plot", "--repeats", "8", "--target", "50 %", where=tmp_path
    )
    assert done.returncode == 0, done.stderr
    (table,) = json.loads(done.stdout)
    # The eighth round is left out where the first seven settled (`runner/rounds.py`).
    assert table["repeats"] in (7, 8)
    assert {len(row["samples"]) for row in table["rows"]} == {table["repeats"]}
    assert [answer["target"] for answer in table["targets"]] == [0.5]


@pytest.mark.parametrize(
    ("change", "arguments", "said"),
    [
        (
            ("projected_gauss_seidel]", "projected_gauss_seidl]"),
            (),
            '{file}:19:13: solvers[0]: expected {any}; did you mean "projected_gauss_seidel"?',
        ),
        (("cost:", "#"), (), None),
        (
            ("", ""),
            ("--repeats", "3"),
            "--repeats: expected 7 or more, found 3; of fewer, one slow moment of the machine "
            "decides where the median lies",
        ),
        (
            ("", ""),
            ("--target", "0,1"),
            '--target: expected a percentage above 0, such as 0.1%, found "0,1"',
        ),
        (
            ("", ""),
            ("--target", "-1%"),
            '--target: expected a percentage above 0, such as 0.1%, found "-1%"',
        ),
    ],
    ids=["unknown solver", "no section", "few repeats", "no percentage", "below zero"],
)
def test_what_cannot_be_asked_is_refused_with_a_sentence(
    change: tuple[str, str],
    arguments: tuple[str, ...],
    said: str | None,
    costed: Path,
    tmp_path: Path,
) -> None:
    text = costed.read_text().replace(*change)
    if said is None:
        text = text.partition("#")[0]
        said = "{file}:1:1: no section cost: it says which measure is compared with which truth"
    costed.write_text(text)
    done = lavender("cost", costed, *arguments, where=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    begin, _, end = said.replace("{file}", str(costed)).partition("{any}")
    assert done.stderr.startswith(begin)
    assert done.stderr.rstrip("\n").endswith(end)
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "runs").exists()
