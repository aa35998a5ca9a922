"""`lavender diff`: equal runs are equal, and every kind of difference is found and named."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from damaged_runs import DRAWN, copied, cut, logs, made, verb

from lavendersim import load_experiment, open_run, run
from tests.older_runs import without_digests


@pytest.fixture(scope="module")
def one(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made(DRAWN, tmp_path_factory.mktemp("one"))


def compared(a: Path, b: Path, code: int) -> dict[str, Any]:
    done = verb("diff", a, b, "--json")
    assert (done.code, done.stderr) == (code, "")
    found: dict[str, Any] = json.loads(done.stdout)
    assert found["equal"] == (code == 0)
    return found


def test_the_same_config_run_twice_is_equal(one: Path, tmp_path: Path) -> None:
    again = made(DRAWN, tmp_path)
    found = compared(one, again, 0)
    assert [state["differs"] for state in found["states"]] == ["nothing"] * 2
    done = verb("diff", one, again)
    assert "equal but for the machine and times" in done.stdout
    assert done.stdout.count("equal to the bit, 961 states") == 2


def test_states_are_read_where_no_digest_says_that_logs_are_equal(
    one: Path, tmp_path: Path
) -> None:
    older = copied(one, tmp_path)
    without_digests(older)
    assert compared(one, older, 0)["states"][0]["steps"] == 961


def test_a_key_of_the_config_is_named_by_its_path(one: Path, tmp_path: Path) -> None:
    found = compared(one, made(DRAWN.replace("mass: 1.0", "mass: 2.0"), tmp_path), 1)
    assert found["config"] == [{"path": "scene.bodies.ball.mass", "a": 1.0, "b": 2.0}]
    assert found["paired_by"] == ["e"]
    # A ball falls, and Newton's law throws it back, alike whatever its mass.
    assert [state["bodies"] for state in found["states"]] == [[], []]


def test_cells_of_one_sweep_alone_are_listed(one: Path, tmp_path: Path) -> None:
    other = made(DRAWN.replace("[0.5, 0.52]", "[0.5, 0.6]"), tmp_path)
    found = compared(one, other, 1)
    assert (found["pairs"], found["only_a"], found["only_b"]) == (1, ["e=0.52"], ["e=0.6"])
    assert found["states"][0]["differs"] == "nothing"
    # As the config has them, an axis that one alone has included.
    less = DRAWN.replace(DRAWN[DRAWN.index("sweep:") : DRAWN.index("measure:")], "")
    text = verb("diff", other, made(less.replace("series: e", ""), tmp_path)).stdout
    assert ", values: [0.5, 0.6]}} -> (absent)" in " ".join(text.split())


def test_runs_of_other_axes_are_paired_where_each_has_one_cell(tmp_path: Path) -> None:
    sweep = DRAWN[DRAWN.index("sweep:") : DRAWN.index("measure:")]
    single = DRAWN.replace(sweep, "").replace("series: e", "")
    runs = [
        made(single.replace("restitution: 0.5", f"restitution: {e}"), tmp_path / e)
        for e in ("0.5", "0.52")
        if (tmp_path / e).mkdir() is None
    ]
    found = compared(*runs, 1)
    (state,) = found["states"]
    trace = open_run(runs[0]).cells[0].trace()
    meets = int(trace.contact["step"][0])  # the step whose solve makes the bounce
    assert (state["step"], state["differs"]) == (meets, "poses")
    assert [body["body"] for body in state["bodies"]] == ["ball"]
    (change,) = found["measures"]
    measures = [open_run(run).results()["cells"][0]["measures"]["rebound"] for run in runs]
    assert (change["name"], [change["a"], change["b"]]) == ("rebound", measures)
    assert found["resolved"] == []  # it is the key that is listed already
    assert f"part at step {meets}" in verb("diff", *runs).stdout


def test_an_option_of_the_command_line_is_a_difference_of_resolved_configs(
    one: Path, tmp_path: Path
) -> None:
    (tmp_path / "drop.yaml").write_text(DRAWN)
    experiment = load_experiment(tmp_path / "drop.yaml", solver="jacobi")
    found = compared(one, run(experiment, tmp_path).run.path, 1)
    assert {"path": "numerics.solver", "cells": 2} in [
        {key: row[key] for key in ("path", "cells")} for row in found["resolved"]
    ]


def test_what_one_run_alone_resolves_to_is_a_difference(one: Path, tmp_path: Path) -> None:
    body = "{shape: {kind: sphere, radius: 0.1}, mass: 1.0}"
    grid = "kind: grid, counts: [1, 1, 1], spacing: [1, 1, 1], origin: [9, 0, 9]"
    more = f"  arrangements: {{more: {{{grid}, body: {body}}}}}\n"
    found = compared(one, made(DRAWN.replace("numerics:", more + "numerics:", 1), tmp_path), 1)
    [added] = [row for row in found["resolved"] if "bodies.more" in row["path"]]
    assert (added["a"], added["b"]["mass"], added["cells"]) == ("(absent)", 1.0, 2)


def test_an_environment_that_is_nested_without_end_is_damaged(one: Path, tmp_path: Path) -> None:
    spoilt = copied(one, tmp_path)
    without_digests(spoilt)
    (spoilt / "env.json").write_text("[" * 100_000)
    done = verb("diff", one, spoilt)
    assert (done.code, done.stdout) == (3, "")
    assert done.stderr.startswith(f"{spoilt / 'env.json'}: damaged: ")


def test_a_damaged_log_is_not_compared(one: Path, tmp_path: Path) -> None:
    spoilt = copied(one, tmp_path)
    cut(logs(spoilt)[0], 0.7)
    done = verb("diff", one, spoilt)
    assert (done.code, done.stdout) == (3, "")
    assert "nothing is compared; --allow-incomplete" in done.stderr
    part = verb("diff", one, spoilt, "--allow-incomplete")
    assert part.code == 3
    assert "states of equal times" in part.stdout


def test_what_is_no_run_is_a_mistake_of_usage(one: Path, tmp_path: Path) -> None:
    done = verb("diff", one, tmp_path)
    assert (done.code, done.stdout) == (2, "")
    assert "not the directory of a run" in done.stderr
