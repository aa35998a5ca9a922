"""Exit codes and streams of the command line: 0 good, 1 a check failed, 2 usage, 3 a log."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from command_line import lavender, started_lavender

# Rests on another ball on the floor: one sweep cannot carry both, so its steps do not converge.
ON_THE_BALL = """
    low: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [5, 0, 0.1]}
    high: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [5, 0, 0.3]}"""


def test_a_good_run_exits_0_and_leaves_a_finished_run(drop: Path, tmp_path: Path) -> None:
    done = started_lavender("run", drop, where=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "pass  rebound" in done.stdout
    latest = tmp_path / "runs" / "latest"
    names = {path.name for path in latest.iterdir()}
    assert {"config.yaml", "resolved.json", "cells", "results.json", "env.json", "DONE"} <= names
    assert len(list((latest / "cells").glob("*.mcap"))) == 1


def test_an_unmet_expectation_exits_1_and_shows_what_was_measured(
    drop: Path, tmp_path: Path
) -> None:
    drop.write_text(drop.read_text().replace("[0.02, 0.03]", "[0.2, 0.3]"))
    done = lavender("run", drop, where=tmp_path)
    assert done.returncode == 1
    for part in ("FAIL  rebound", "measured", "expected   between 0.2 and 0.3", ".mcap"):
        assert part in done.stdout
    assert "Traceback" not in done.stderr


def test_every_defect_of_every_file_is_reported_before_anything_runs(
    drop: Path, tmp_path: Path
) -> None:
    (tmp_path / "a.yaml").write_text(drop.read_text().replace("mass: 1.0", "mass: -1.0"))
    (tmp_path / "b.yaml").write_text(drop.read_text().replace("duration", "durration"))
    done = lavender("run", tmp_path, where=tmp_path)
    assert done.returncode == 2
    assert f"{tmp_path}/a.yaml:8:" in done.stderr
    assert f"{tmp_path}/b.yaml:" in done.stderr
    assert "duration" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "runs").exists()


@pytest.mark.parametrize("verb", ["plot", "show", "replay"])
def test_without_a_run_one_sentence_says_how_to_make_one(verb: str, tmp_path: Path) -> None:
    done = lavender(verb, where=tmp_path)
    assert done.returncode == 2
    assert done.stderr == "runs has no finished run: start one with `lavender run CONFIG`\n"


def test_json_output_is_one_document(drop: Path, tmp_path: Path) -> None:
    done = lavender("run", drop, "--json", where=tmp_path)
    (table,) = json.loads(done.stdout)
    assert table["passed"] is True
    assert table["cells"][0]["measures"]["rebound"] == pytest.approx(0.025, rel=0.1)
    # 0.5 s at 240 Hz
    assert table["cells"][0]["steps"] == 120


def test_the_verbs_of_a_run_read_what_it_left(drop: Path, tmp_path: Path) -> None:
    lavender("run", drop, where=tmp_path)
    assert "pass  runs/" in lavender("ls", where=tmp_path).stdout
    shown = lavender("show", where=tmp_path).stdout
    assert "How high?" in shown
    assert re.search(r"^  gravity +on   gravity is \(0, 0, -9.81\) m/s\^2$", shown, re.M)
    assert re.search(r"^  off: .*\brotation\b", shown, re.M)
    checked = lavender("check", drop, where=tmp_path)
    assert "1 of 1 expectations met, 1 of 1 cells complete" in checked.stdout
    plan = json.loads(lavender("plan", drop, "--json", where=tmp_path).stdout)
    assert plan["effects"]["rotation"]["on"] is False
    assert plan["spec"]["shape_pairs"] == ["sphere_plane"]
    no_figure = lavender("plot", where=tmp_path)
    assert no_figure.returncode == 2
    assert "no figure section" in no_figure.stderr


def test_a_folder_with_runs_in_it_is_run_and_collected_again(drop: Path, tmp_path: Path) -> None:
    assert lavender("run", ".", where=tmp_path).returncode == 0
    assert lavender("run", ".", where=tmp_path).returncode == 0
    collected = subprocess.run(
        [sys.executable, "-m", "pytest", "--collect-only", "-q", "-p", "no:cacheprovider", "."],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert collected.returncode == 0, collected.stdout
    items = [line for line in collected.stdout.splitlines() if "::" in line]
    assert items == ["drop.yaml::every cell completes", "drop.yaml::rebound"]


def test_a_diverged_run_is_a_failed_one_even_where_nothing_is_expected(
    drop: Path, tmp_path: Path
) -> None:
    text = drop.read_text()
    text = text[: text.index("measure:\n")].replace("duration: 0.5", "duration: 10")
    drop.write_text(text.replace("mass: 1.0", "mass: 1.0\n      velocity: [1.0e+308, 0, 0]"))
    assert lavender("run", drop, where=tmp_path).returncode == 1
    assert lavender("ls", where=tmp_path).stdout.startswith("FAIL")
    checked = lavender("check", drop, "--json", where=tmp_path)
    assert checked.returncode == 1
    table = json.loads(checked.stdout)
    assert table["passed"] is False
    assert table["cells"][0]["status"].startswith("diverged: body ball is no longer finite")


def test_an_interrupted_run_is_listed_and_its_finished_cells_can_be_replayed(
    drop: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from lavendersim.experiment import load_experiment
    from lavendersim.runner import Progress, list_runs, open_run, run

    drop.write_text(
        drop.read_text().replace(
            "measure:\n",
            "sweep:\n  e: {path: scene.bodies.ball.surface.restitution, values: [0.5, 0.6]}\n"
            "measure:\n",
        )
    )

    def interrupt(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(load_experiment(drop), tmp_path / "runs", progress=Progress(cell_done=interrupt))
    (left,) = list_runs(tmp_path / "runs")
    assert not left.finished
    assert [cell.status for cell in left.cells] == ["complete", "pending"]
    assert open_run(left.path).cells[0].trace().status == "complete"
    assert lavender("ls", where=tmp_path).stdout.startswith("----")
    shown = lavender("show", left.path, where=tmp_path)
    assert shown.returncode == 2
    assert "did not finish" in shown.stderr


def test_without_its_newest_run_the_next_one_is_the_latest(drop: Path, tmp_path: Path) -> None:
    import shutil

    from lavendersim.runner import open_run

    lavender("run", drop, where=tmp_path)
    first = open_run(None, tmp_path / "runs").path
    lavender("run", drop, where=tmp_path)
    second = open_run(None, tmp_path / "runs").path
    assert second != first
    shutil.rmtree(second)
    assert open_run(None, tmp_path / "runs").path == first


def test_a_path_that_cannot_be_written_is_one_sentence(drop: Path, tmp_path: Path) -> None:
    (tmp_path / "afile").write_text("")
    done = lavender("run", drop, "--runs", tmp_path / "afile", where=tmp_path)
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1
    assert "afile: file exists" in done.stderr


def test_costs_are_printed_by_cell_and_compilation_once(drop: Path, tmp_path: Path) -> None:
    text = drop.read_text()
    swept = "sweep:\n  e: {path: scene.bodies.ball.surface.restitution, values: [0.5, 0.52]}\n"
    drop.write_text(text.replace("measure:\n", swept + "measure:\n"))
    done = lavender("run", drop, where=tmp_path)
    assert done.returncode == 0, done.stderr
    assert re.search(
        r"^drop: 2 cells, 240 steps; logging [\d.]+ us/step, compile [\d.]+ s$", done.stdout, re.M
    )
    for value in ("0.5", "0.52"):
        assert re.search(rf"^  physics +[\d.]+ us/step  e={value}$", done.stdout, re.M)
    shown = lavender("show", where=tmp_path).stdout
    assert re.search(r"^cells  logging [\d.]+ us/step, compile [\d.]+ s$", shown, re.M)
    assert re.search(r"e=0.52  complete  physics [\d.]+ us/step  residual <= \S+ m/s", shown)


def test_an_accuracy_that_was_missed_is_a_warning(drop: Path, tmp_path: Path) -> None:
    text = drop.read_text().replace("\n    ball:", ON_THE_BALL + "\n    ball:")
    text = text[: text.index("measure:\n")]
    drop.write_text(
        text.replace(
            "numerics: chapter",
            "numerics: {preset: chapter, sweeps: 1, warm_start: false, tolerance: 1e-9}",
        )
    )
    done = lavender("run", drop, where=tmp_path)
    assert done.returncode == 0
    sentence = r"^drop: \d+ of 120 steps ended above the tolerance 1e-09 m/s, worst \S+ m/s$"
    assert re.search(sentence, done.stderr, re.M)
    assert re.search(sentence, lavender("check", drop, where=tmp_path).stderr, re.M)
    assert re.search(
        r"\(\d+ of 120 steps above the tolerance 1e-09 m/s\)",
        lavender("show", where=tmp_path).stdout,
    )


def test_a_sweep_over_solvers_has_a_plan_for_each(drop: Path, tmp_path: Path) -> None:
    solvers = "[projected_gauss_seidel, nonsmooth_conjugate_gradient]"
    drop.write_text(
        drop.read_text().replace(
            "measure:\n",
            f"sweep:\n  s: {{path: numerics.solver, values: {solvers}}}\nmeasure:\n",
        )
    )
    plans = json.loads(lavender("plan", drop, "--json", where=tmp_path).stdout)
    assert plans["spec"]["solver"] == "projected_gauss_seidel"
    assert [one["spec"]["solver"] for one in plans["others"]] == ["nonsmooth_conjugate_gradient"]
    printed = lavender("plan", drop, where=tmp_path).stdout
    assert printed.count("\nshape pair ") == 2
    assert (
        "\ndrop: solver: nonsmooth_conjugate_gradient (s=nonsmooth_conjugate_gradient)\n" in printed
    )


def test_a_cell_that_diverges_exits_1_and_the_others_complete(drop: Path, tmp_path: Path) -> None:
    text = drop.read_text().replace("scene:\n", "scene:\n  gravity: [0, 0, -9.81]\n", 1)
    text += "sweep:\n  pull: {path: scene.gravity.2, values: [-9.81, 1e155, -9.8]}\n"
    drop.write_text(text.replace("expect:\n", "always: {energy: none, residual: none}\nexpect:\n"))
    done = lavender("check", drop, "--json", where=tmp_path)
    assert done.returncode == 1
    table = json.loads(done.stdout)
    ended = [cell["status"] for cell in table["cells"]]
    assert ended[0] == ended[2] == "complete"
    assert ended[1].startswith("diverged: body ball is no longer finite after step ")
    whole = [one for one in table["verdicts"] if "1e+155" not in one["node"]]
    assert len(whole) == 2 * (1 + 4)
    assert all(one["passed"] for one in whole)


@pytest.mark.skipif(os.name != "posix", reason="pipes of POSIX")
def test_runs_go_on_when_nobody_reads_what_they_print(drop: Path, tmp_path: Path) -> None:
    for name in ("a", "b", "c"):
        (tmp_path / f"{name}.yaml").write_text(drop.read_text())
    names = [f"{name}.yaml" for name in ("a", "b", "c")]
    command = [sys.executable, "-m", "lavender_cli.main", "run", *names]
    read, write = os.pipe()
    with subprocess.Popen(command, cwd=tmp_path, stdout=write, stderr=subprocess.PIPE) as run:
        os.close(write)
        os.close(read)  # the reader has gone before the first line
        assert run.stderr is not None
        said = run.stderr.read()
    assert (run.returncode, b"Traceback" in said) == (0, False), said
    assert len(list((tmp_path / "runs").glob("*/DONE"))) == 1 + 3  # and by the link


@pytest.mark.skipif(os.name != "posix", reason="pipes of POSIX")
def test_a_pipe_is_no_config(tmp_path: Path) -> None:
    """Nobody writes into it: opened, it would wait for ever."""
    os.mkfifo(tmp_path / "drop.yaml")
    for verb in ("run", "check", "plan"):
        done = lavender(verb, "drop.yaml", where=tmp_path)
        assert (done.returncode, done.stderr) == (
            2,
            "drop.yaml: expected a file, this is a pipe or a device\n",
        )
