"""Cells as jobs: those that are the same simulation have one log, and run once."""

from __future__ import annotations

from pathlib import Path

from lavendersim.experiment import load_experiment_text
from lavendersim.runner.cell_jobs import different, prepare
from tests.drop_config import DROP

RESTITUTION = "{path: scene.bodies.ball.surface.restitution, values: [0.5, 0.8]}"
SWEPT = DROP + f"sweep:\n  - {{e: {RESTITUTION}}}\n  - {{again: {RESTITUTION}}}\n"


def test_a_job_for_every_cell_with_its_plan_and_log(tmp_path: Path) -> None:
    prepared = prepare(load_experiment_text(SWEPT, "drop.yaml"))
    jobs = prepared.jobs(tmp_path)
    assert [job.path for job in jobs] == [tmp_path / "cells" / log for log in prepared.logs]
    assert len({id(plan) for plan in prepared.plans}) == 1


def test_cells_of_two_products_that_are_one_simulation_have_one_log(tmp_path: Path) -> None:
    jobs = prepare(load_experiment_text(SWEPT, "drop.yaml")).jobs(tmp_path)
    assert len(jobs) == 4
    once = different(jobs)
    assert [[cell[0] for cell in job.cells] for job in once.values()] == [[0, 2], [1, 3]]
    assert list(once) == [jobs[0].path, jobs[1].path]


def test_a_log_is_named_by_what_it_depends_on() -> None:
    one, other = (
        prepare(load_experiment_text(text, name)).logs
        for text, name in ((DROP, "a.yaml"), (DROP.replace("How high?", "Why?"), "b.yaml"))
    )
    assert one == other  # neither the file's name nor the question is simulated
    longer = DROP.replace("duration: 0.5", "duration: 0.6")
    assert prepare(load_experiment_text(longer, "a.yaml")).logs != one
