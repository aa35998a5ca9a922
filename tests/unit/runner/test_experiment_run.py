"""Directories of runs, what ended early, and the configs of cells as they stand beside the logs."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.durable_files import MOST_BYTES
from lavendersim.experiment import Experiment, load_experiment_text
from lavendersim.runner.experiment_run import (
    Finished,
    _index_of,
    _plain,
    _short,
    _write_resolved,
    make_directory,
)
from lavendersim.runner.run_index import PENDING
from lavendersim.trace.whole import LogDigest
from tests.marked_config import config


def made(name: str = "drop.yaml", **options: Any) -> Experiment:
    return load_experiment_text(config(), name, **options)


def test_directories_sort_by_age_also_within_a_second(tmp_path: Path) -> None:
    paths = [make_directory(made(), tmp_path) for _ in range(12)]
    assert [path.name for path in paths] == sorted(path.name for path in tmp_path.iterdir())
    assert len(set(paths)) == 12


def test_a_name_says_experiment_solver_and_overrides_and_ends_with_what_was_read(
    tmp_path: Path,
) -> None:
    options = {"solver": "jacobi", "overrides": ("set scene.bodies.ball.mass=3",)}
    stamp, *words, digest = make_directory(made(**options), tmp_path).name.split("-")
    assert stamp.rstrip("Z.0123456789T") == ""
    assert words == ["drop", "jacobi", "mass=3"]
    other = make_directory(made(overrides=("set scene.bodies.ball.mass=4",)), tmp_path)
    assert other.name.rsplit("-", 1)[1] != digest
    text = config() + "\n" + options["overrides"][0]
    assert digest == hashlib.sha256(text.encode()).hexdigest()[:8]


def test_a_name_is_no_longer_than_a_file_system_takes(tmp_path: Path) -> None:
    path = make_directory(made(), tmp_path, in_text=[f"a.key_{k}={'x' * 99}" for k in range(9)])
    assert len(path.name) <= len("20260101T000000Z.000-") + MOST_BYTES + len("-12345678")
    assert _short("scene.bodies.ball.mass=1/3") == "mass=1_3"
    assert _short("sweep e=scene.bodies.ball.surface.restitution:[0.2, 0.5]") == "e=0.2_0.5"
    assert "/" not in _short("a.b=../../etc")


def test_no_name_of_a_config_is_obeyed_by_a_terminal_or_too_long_for_a_disk(tmp_path: Path) -> None:
    for name, words in (("a\x1b[31mb", "a_[31mb"), ("b\udcffc", "b_c"), ("\u202ed", "_d")):
        assert make_directory(made(f"{name}.yaml"), tmp_path).name.split("-")[1] == words
    long = make_directory(made("字" * 80 + ".yaml"), tmp_path).name  # 240 of 255 bytes
    words, digest = long.split("-")[1:3]  # 150 bytes with the digest of the name
    assert words == "字" * 47
    assert len(digest) == 8
    assert len(long.encode()) <= 255


def digest_of(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def test_resolved_configs_are_a_list_that_json_reads_with_the_digests_of_the_logs(
    tmp_path: Path,
) -> None:
    swept = load_experiment_text(config(sweep="{t: {path: duration, values: [1, 2]}}"), "a.yaml")
    digests = _write_resolved(tmp_path / "resolved.json", swept.cells())
    rows = json.loads((tmp_path / "resolved.json").read_text())
    assert [(row["index"], row["label"]) for row in rows] == [(0, "t=1"), (1, "t=2")]
    assert [row["config"]["duration"] for row in rows] == [1.0, 2.0]
    # the log of a cell has the same text attached
    assert digests == [digest_of(cell.config.as_json()) for cell in swept.cells()]


def test_cells_that_did_not_end_are_pending_in_the_index() -> None:
    swept = load_experiment_text(config(sweep="{t: {path: duration, values: [1, 1.5]}}"), "a.yaml")
    paths = [Path("run/cells/a.mcap"), Path("run/cells/b.mcap")]
    jobs: Any = [SimpleNamespace(path=path) for path in paths]
    ended: Any = {paths[1]: SimpleNamespace(status="complete", log=LogDigest(1, 2, "3"))}
    first, second = _index_of(swept, jobs, ["x", "y"], ended).cells
    assert (first.status, first.log, first.file) == (PENDING, None, "cells/a.mcap")
    assert (second.status, second.log) == ("complete", LogDigest(1, 2, "3"))
    assert second.coordinates == {"t": 1.5}


def test_coordinates_are_what_json_has() -> None:
    from fractions import Fraction

    assert _plain(Fraction(1, 3)) == "1/3"
    assert [_plain(one) for one in (1, 0.5, True, "a")] == [1, 0.5, True, "a"]


@pytest.mark.parametrize(
    ("statuses", "controls", "passed", "good"),
    [
        (["complete"], (), True, True),
        (["complete"], (), False, False),
        (["diverged: ball"], (), True, False),
        (["diverged: ball"], ("diverges",), True, True),
    ],
)
def test_a_run_is_good_where_its_cells_ended_as_they_should_and_its_claims_are_met(
    statuses: list[str], controls: tuple[str, ...], passed: bool, good: bool
) -> None:
    cells = [SimpleNamespace(index=k, status=one, coordinates={}) for k, one in enumerate(statuses)]
    failing = [SimpleNamespace(fails=name, at={}) for name in controls]
    run: Any = SimpleNamespace(cells=cells, experiment=SimpleNamespace(controls=failing))
    verdicts: Any = [SimpleNamespace(passed=passed, fails=not passed)]
    assert Finished(run, [], verdicts, verdicts).good is good
