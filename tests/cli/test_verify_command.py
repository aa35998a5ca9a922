"""`verify` sees every change of a run; `judge` needs nothing of it but config, index and logs."""

from __future__ import annotations

import hashlib
import json
import random
from pathlib import Path

import pytest
from damaged_runs import DRAWN, copied, cut, flip, logs, made, verb

from lavendersim import open_run
from lavendersim.trace import source
from tests.older_runs import without_digests

ALWAYS = "always: {speed: 50.0}\n"
DIVERGING = (
    DRAWN.replace("scene:\n", "scene:\n  gravity: [0, 0, -9.81]\n", 1)
    .replace("scene.bodies.ball.surface.restitution", "scene.gravity.2")
    .replace("[0.5, 0.52]", "[-9.81, 1e155]")
)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished run of two cells."""
    return made(DRAWN + ALWAYS, tmp_path_factory.mktemp("whole"))


def sealed_again(run: Path) -> None:
    """Write the seal anew, as who changes a table with its digest."""
    names = [line.split("  ")[1] for line in (run / "DONE").read_text().splitlines()]
    digests = {name: hashlib.sha256((run / name).read_bytes()).hexdigest() for name in names}
    (run / "DONE").write_text("".join(f"{digest}  {name}\n" for name, digest in digests.items()))


def test_a_whole_run_is_verified_in_one_line(whole: Path) -> None:
    done = verb("verify", whole)
    assert (done.code, done.stderr) == (0, "")
    assert done.stdout.startswith(f"{whole}: whole: 2 logs, ")


def test_cells_that_ended_early_are_as_whole(tmp_path: Path) -> None:
    run = made(DIVERGING + ALWAYS, tmp_path)
    assert not open_run(run).results()["passed"]
    done = verb("verify", run)
    assert (done.code, done.stderr) == (0, ""), done.stdout
    assert verb("judge", run).code == 1


def test_every_flipped_bit_of_every_file_is_seen(whole: Path, tmp_path: Path) -> None:
    draw = random.Random(17)
    files = [f for f in whole.rglob("*") if f.is_file() and "figures" not in f.parts]
    assert len(files) == 9
    for number in range(45):
        run = copied(whole, tmp_path / str(number))
        file = run / files[number % len(files)].relative_to(whole)
        flip(file, draw.randrange(file.stat().st_size), draw.randrange(8))
        done = verb("verify", run)
        assert (done.code, done.stderr) == (3, ""), file
        assert done.stdout.startswith(str(run)), file
        assert "Traceback" not in done.stdout


def test_results_that_no_log_gives_are_seen_behind_a_good_seal(whole: Path, tmp_path: Path) -> None:
    run = copied(whole, tmp_path)
    results = json.loads((run / "results.json").read_text())
    results["cells"][1]["measures"]["rebound"] *= 1.0 + 2**-52  # one unit in the last place
    (run / "results.json").write_text(json.dumps(results))
    sealed_again(run)
    assert verb("show", run).code == 0
    done = verb("verify", run)
    assert done.code == 3
    (line,) = done.stdout.splitlines()
    assert line.startswith(f"{run / 'results.json'}: cell 1 (e=0.52): rebound is ")


def test_a_verdict_that_no_log_gives_is_seen(whole: Path, tmp_path: Path) -> None:
    run = copied(whole, tmp_path)
    results = json.loads((run / "results.json").read_text())
    results["checks"][0]["passed"] = not results["checks"][0]["passed"]
    (run / "results.json").write_text(json.dumps(results))
    sealed_again(run)
    done = verb("verify", run)
    assert done.code == 3
    assert "judged again it is another verdict" in done.stdout


def test_every_damaged_log_has_a_line(whole: Path, tmp_path: Path) -> None:
    run = copied(whole, tmp_path)
    for log in logs(run):
        cut(log, 0.9)
    done = verb("verify", run)
    assert done.code == 3
    assert sorted(line.split(": ")[0] for line in done.stdout.splitlines()) == [
        *map(str, logs(run))
    ]


def test_a_run_that_did_not_finish_is_no_whole_one(whole: Path, tmp_path: Path) -> None:
    run = copied(whole, tmp_path)
    (run / "DONE").unlink()
    done = verb("verify", run)
    assert done.code == 3
    assert done.stdout == f"{run}: did not finish: 2 of 2 logs are whole\n"


def test_an_older_run_is_verified_without_digests_and_that_is_said(
    whole: Path, tmp_path: Path
) -> None:
    run = without_digests(copied(whole, tmp_path))
    done = verb("verify", run)
    assert done.code == 0
    assert "without digests" in done.stderr
    (run / "results.json").write_text((run / "results.json").read_text().replace("rebound", "r"))
    assert verb("verify", run).code == 3


def test_judge_gives_from_the_logs_the_verdicts_of_the_run(whole: Path, tmp_path: Path) -> None:
    results = open_run(whole).results()
    run = copied(whole, tmp_path)
    for name in ("results.json", "results.csv", "DONE", "env.json"):
        (run / name).unlink()
    done = verb("judge", run, "--json")
    assert done.stderr == ""
    judged = json.loads(done.stdout)
    assert judged["passed"] == results["passed"]
    assert done.code == (0 if results["passed"] else 1)
    assert [cell["measures"] for cell in judged["cells"]] == [
        cell["measures"] for cell in results["cells"]
    ]
    for key in ("node", "passed", "measured", "expected"):
        assert [one[key] for one in judged["checks"]] == [one[key] for one in results["checks"]]


def test_judge_fails_the_claims_on_a_damaged_log_and_says_so(whole: Path, tmp_path: Path) -> None:
    run = copied(whole, tmp_path)
    cut(logs(run)[0], 0.9)
    done = verb("judge", run, "-v")
    assert done.code == 3
    assert "unfinished, its end is missing" in done.stderr
    assert "a log that can answer" in done.stdout


def test_logs_whose_configs_this_version_cannot_read_are_no_other_verdicts(
    whole: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def of_another(data: object) -> None:
        raise source._OtherVersion("1 validation error\nrecord.problems\n  Field required")

    monkeypatch.setattr(source, "_config_of", of_another)
    done = verb("verify", whole)
    assert (done.code, done.stderr) == (3, "")
    (line,) = done.stdout.splitlines()
    assert line.endswith(
        ".mcap: its config was written by another version: record.problems: Field required; "
        "its measures and verdicts are not compared"
    )
