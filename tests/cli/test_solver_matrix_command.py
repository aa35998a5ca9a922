"""`lavender check --solver`: every case by every solver, as a table, as data and as a page."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import unquote

import psutil
import pytest
from command_line import lavender
from page_reader import Page, opened_in_a_browser

WITHIN = 30.0  # [s], of a machine that does much besides
SOLVERS = ("block_gauss_seidel", "projected_gauss_seidel")
# At rest on the floor: any solver holds it, in one sweep.
REST = """\
question: Does it <stay>?
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 0.1]}
duration: 0.1
always: {stop: false}
measure:
  drift: {kind: drift, after: 0}
expect:
  - {name: stays, measure: drift, at_most: 1e-6}
"""
SUNK = REST.replace("0, 0, 0.1]", "0, 0, 0.05]")  # half a radius deep, ten times the bound
KNOWN = (
    '  - {name: "known failure, way", fails: stays}\n'
    '  - {name: "known failure, depth", fails: penetration}\n'
)
CONTROL = "  - {name: it must sink, fails: penetration}\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two cases that are put to solvers, and a control that is not."""
    folder = tmp_path_factory.mktemp("matrix")
    (folder / "ball").mkdir()
    (folder / "ball" / "rest.yaml").write_text(REST)
    (folder / "ball" / "sunk.yaml").write_text(SUNK + KNOWN)
    (folder / "ball" / "control.yaml").write_text(SUNK + CONTROL)
    return folder


@pytest.fixture(scope="module")
def done(folder: Path) -> subprocess.CompletedProcess[str]:
    """The matrix as data, with its page."""
    named = ",".join(SOLVERS)
    return lavender(
        *("check", "ball", "--solver", named, "--json", "--report", "pages/matrix.html"),
        where=folder,
    )


def test_known_failures_are_no_passes_and_end_well(
    done: subprocess.CompletedProcess[str],
) -> None:
    assert done.returncode == 0, done.stderr
    table = json.loads(done.stdout)
    assert table["cases"] == ["ball/rest", "ball/sunk"]
    assert table["left_out"] == {"ball/control": "must fail (a negative control)"}
    verdicts = {(one["case"], one["solver"]): one["verdict"] for one in table["entries"]}
    assert verdicts == {
        (case, solver): said
        for case, said in (("ball/rest", "passes"), ("ball/sunk", "known failure"))
        for solver in SOLVERS
    }
    assert table["solvers"] == dict.fromkeys(SOLVERS, 1)


def test_the_progress_of_every_entry_is_reported(done: subprocess.CompletedProcess[str]) -> None:
    lines = [line for line in done.stderr.splitlines() if " of 4  " in line]
    assert [line.split()[0] for line in lines] == ["1", "2", "3", "4"]


def test_every_run_says_its_solver_and_can_be_shown(
    done: subprocess.CompletedProcess[str], folder: Path
) -> None:
    for one in json.loads(done.stdout)["entries"]:
        assert one["solver"] in Path(one["run"]).name
        assert (folder / one["log"]).is_file()
    run = json.loads(done.stdout)["entries"][0]["run"]
    shown = lavender("show", run, where=folder)
    assert shown.returncode == 0, shown.stderr
    assert f"solver  {SOLVERS[0]}, instead of the config's" in shown.stdout
    as_data = json.loads(lavender("show", run, "--json", where=folder).stdout)
    assert as_data["solver"] == SOLVERS[0]


def test_the_log_was_made_by_the_solver_it_says(
    done: subprocess.CompletedProcess[str], folder: Path
) -> None:
    from lavendersim.trace import open_trace

    for one in json.loads(done.stdout)["entries"]:
        trace = open_trace(folder / one["log"])
        assert trace.metadata["engine"]["solver"] == one["solver"]
        assert trace.config.numerics.solver == one["solver"]


def test_the_page_has_an_entry_for_every_case_and_solver(
    done: subprocess.CompletedProcess[str], folder: Path
) -> None:
    text = (folder / "pages" / "matrix.html").read_text(encoding="utf-8")
    page = Page(text)
    page.needs_nothing_else()
    assert [row["data-case"] for row in page.all("tr", "case")] == ["ball/rest", "ball/sunk"]
    assert [head["data-solver"] for head in page.all("th", "solver")] == list(SOLVERS)
    assert len(page.all("td", "entry passes")) == 2
    known = page.all("td", "entry known")
    assert len(known) == 2
    assert all(one["title"].startswith("known failure: stays: ") for one in known)
    # one picture a case, however many solvers
    assert len(page.all("img")) == 2
    links = [link["href"] for link in page.all("a")]
    assert len(set(links)) == 4
    for link in links:
        assert (folder / "pages" / unquote(link)).suffix == ".mcap"
        assert (folder / "pages" / unquote(link)).is_file()
    assert "Does it <stay>?" in page.text
    assert "must fail (a negative control): ball/control" in page.text


def test_the_page_opens_in_a_browser(
    done: subprocess.CompletedProcess[str], folder: Path, tmp_path: Path
) -> None:
    page = opened_in_a_browser(folder / "pages" / "matrix.html", tmp_path)
    assert len(page.all("tr", "case")) == 2


def test_what_is_not_declared_exits_1_and_stands_below_the_table(
    folder: Path, tmp_path: Path
) -> None:
    sunk = tmp_path / "sunk.yaml"
    sunk.write_text(SUNK)
    done = lavender("check", sunk, folder / "ball" / "rest.yaml", "-s", SOLVERS[0], where=tmp_path)
    assert done.returncode == 1
    lines = [" ".join(line.split()) for line in done.stdout.splitlines()]
    assert "ball/rest pass" in lines
    assert f"{tmp_path.name}/sunk FAIL" in lines
    assert "passed 1 of 2" in lines
    (line,) = [line for line in lines if "FAIL stays: " in line]
    assert line.endswith("expected at most 1e-06")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["ball", "--solver", "jacoby"], 'no solver is called "jacoby"; did you mean "jacobi"?\n'),
        (
            ["ball/control.yaml", "--solver", "all"],
            "nothing here is put to several solvers: ball/control must fail (a negative control)\n",
        ),
    ],
)
def test_what_cannot_be_asked_is_refused_in_a_sentence(
    folder: Path, arguments: list[str], said: str
) -> None:
    done = lavender("check", *arguments, where=folder)
    errors = [line for line in done.stderr.splitlines(keepends=True) if "warning:" not in line]
    assert (done.returncode, done.stdout, "".join(errors)) == (2, "", said)


@pytest.mark.skipif(sys.platform == "win32", reason="signals of a terminal are Unix's")
@pytest.mark.parametrize("jobs", [1, 2])
def test_ctrl_c_twice_ends_every_process_of_a_matrix(tmp_path: Path, jobs: int) -> None:
    """A terminal sends it to all of them; who holds the key sends it again."""
    long = tmp_path / "long.yaml"
    long.write_text(REST.replace("duration: 0.1", "duration: 2e4"))
    words = ["check", long, "--solver", ",".join(SOLVERS), "--jobs", jobs, "--runs", "runs"]
    started = subprocess.Popen(
        [sys.executable, "-m", "lavender_cli.main", *map(str, words)],
        cwd=tmp_path,
        start_new_session=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    begin = time.monotonic()
    while not [*tmp_path.glob("runs/*/cells/*")]:
        assert time.monotonic() < begin + 4.0 * WITHIN
        assert started.poll() is None
        time.sleep(0.01)
    children = psutil.Process(started.pid).children(recursive=True)
    for _ in range(2):
        os.killpg(started.pid, signal.SIGINT)
        time.sleep(0.05)
    started.communicate(timeout=WITHIN)
    assert started.returncode == 130
    gone, alive = psutil.wait_procs(children, WITHIN)
    for left in alive:
        left.kill()
    assert gone
    assert alive == []
