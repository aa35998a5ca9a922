"""A process that dies is replaced, and its task done once more; the other tasks go on."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil
import pytest
from deadly_tasks import Task, dies_at_one_half, dies_once_at_one_half, exits, meets, squared

import lavendersim
from lavendersim.figures.config_figure import compose
from lavendersim.runner import Progress, executor, workers
from lavendersim.runner.workers import AHEAD, Death, Retried, work
from tests.runner.small_configs import DROPS, write


@pytest.fixture(autouse=True, params=["forked", "spawned"])
def way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Start processes in either way, whatever threads pytest has."""
    if request.param == "forked" and sys.platform != "linux":
        pytest.skip("processes are forked on Linux")
    monkeypatch.setattr(workers, "may_fork", lambda: request.param == "forked")


def test_every_task_is_done_once_by_any_number_of_processes(tmp_path: Path) -> None:
    before = set(psutil.Process().children())  # such as the server that other tests fork from
    for count in (1, 3):
        notes = tmp_path / str(count)
        notes.mkdir()
        tasks = [Task(number, notes) for number in range(5 * AHEAD)]
        found = list(work(squared, tasks, count))
        assert sorted(task.number for task, _ in found) == [*range(5 * AHEAD)]
        assert all(result == task.number**2 for task, result in found)
        assert len(list(notes.iterdir())) == len(tasks)
    left = set(psutil.Process().children()) - before
    assert all("resource_tracker" in " ".join(child.cmdline()) for child in left)


def test_no_task_waits_behind_another_while_a_process_has_none(tmp_path: Path) -> None:
    tasks = [Task(number, tmp_path) for number in range(3)]
    assert sorted(number for _, number in work(meets, tasks, 3)) == [0, 1, 2]


def test_a_task_whose_process_dies_is_done_once_more(tmp_path: Path) -> None:
    again: list[Retried[Task]] = []
    tasks = [Task(number, tmp_path, deaths=number == 2) for number in range(6)]
    found = dict(work(squared, tasks, 2, again.append))
    assert found == {task: task.number**2 for task in tasks}
    assert again == [Retried(tasks[2], Death("was killed by SIGKILL"))]
    # what its process had before it was not done twice, nor what was waiting
    assert len(list(tmp_path.iterdir())) == len(tasks) + 1


def test_of_a_group_the_task_is_named_that_its_process_died_of(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Tasks of no time are given many at once; those before the deadly one have lost results."""
    given: list[int] = []
    real = workers._Worker.give

    def give(self: Any, groups: list[list[int]]) -> None:
        given.extend(map(len, groups))
        real(self, groups)

    monkeypatch.setattr(workers, "EVERY", 60.0)  # then groups are as large as what is left allows
    monkeypatch.setattr(workers._Worker, "give", give)
    again: list[Retried[Task]] = []
    deadly = {40: 1, 41: 2, 90: 1}
    tasks = [Task(number, tmp_path, deaths=deadly.get(number, 0)) for number in range(120)]
    found = list(work(squared, tasks, 2, again.append))
    assert sorted(task.number for task, _ in found) == [*range(120)]  # each is answered once
    died = Death("was killed by SIGKILL")
    assert {task.number: one for task, one in found if one == died} == {41: died}
    assert all(one == task.number**2 for task, one in found if task.number != 41)
    assert sorted(one.task.number for one in again) == [*deadly]
    forked = workers.may_fork()
    assert (max(given) > 4) == forked  # a spawned process is given one at a time
    notes = [path.name.split("-")[0] for path in tmp_path.iterdir()]
    if not forked:
        assert len(notes) == len(tasks) + len(again)
    assert max(map(notes.count, notes)) <= 1 + sum(deadly.values())  # deaths that it shared


def test_a_second_death_is_the_result_and_the_others_go_on(tmp_path: Path) -> None:
    tasks = [Task(number, tmp_path, deaths=2 * (number in (0, 3))) for number in range(6)]
    found = dict(work(squared, tasks, 2))
    assert found.keys() == set(tasks)
    died = [task.number for task, one in found.items() if one == Death("was killed by SIGKILL")]
    assert sorted(died) == [0, 3]
    assert all(found[task] == task.number**2 for task in tasks if not task.deaths)


def test_an_exit_within_a_task_is_a_death_too() -> None:
    assert list(work(exits, [7], 1)) == [(7, Death("ended with exit code 7"))]


def test_an_exception_of_a_task_is_raised_here_with_where_it_came_from(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="-1 is negative") as raised:
        list(work(squared, [Task(-1, tmp_path)], 2))
    assert "deadly_tasks.py" in raised.value.__notes__[0]


@pytest.mark.parametrize(("function", "times"), [(dies_once_at_one_half, 1), (dies_at_one_half, 2)])
def test_a_sweep_goes_on_when_the_process_of_a_cell_is_killed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, function: Callable[[Any], Any], times: int
) -> None:
    config = write(tmp_path)
    lavendersim.run(config, root=tmp_path / "warm")  # the first cell is run in this process
    monkeypatch.setattr(executor, "run_and_measure", function)
    said: list[str] = []
    finished = lavendersim.run(
        config, root=tmp_path / "runs", jobs=2, progress=Progress(warning=said.append)
    )
    died_of = "the process of cell e=0.5 was killed by SIGKILL"
    given_up = [f"{died_of} again; the cell is given up"] * (times == 2)
    assert said == [f"{died_of}; the cell is run once more", *given_up]
    sentence = "failed: its process was killed by SIGKILL, both times"
    ended = {cell.label: cell.status for cell in finished.run.cells}
    died = {"e=0.5": sentence} if times == 2 else {}
    assert ended == {"e=0.2": "complete", "e=0.5": "complete", "e=0.8": "complete"} | died
    assert finished.good == (times == 1)
    assert [cell.label for cell in finished.ended_early] == [*died]
    assert finished.run.finished
    results = json.loads((finished.run.path / "results.json").read_text())
    assert [row["status"] for row in results["cells"]] == list(ended.values())
    if died:
        assert results["cells"][1]["measures"] == {"rebound": sentence}
        (said_of_cell,) = {check["message"] for check in results["checks"]}
        assert f"e=0.5: {sentence}" in said_of_cell
    figure = compose(finished.run.experiment, finished.run.cells, finished.run.taken)
    caption = " ".join(" ".join(text.get_text() for text in figure.texts).split())
    assert ("Left out: 1 of 3 cells have no readable log" in caption) == bool(died)


def test_of_cells_that_are_run_together_only_the_deadly_one_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Which cell of a batch its process dies of is not known: each is then run by itself."""
    values = [round(0.1 + 0.1 * k, 1) for k in range(8)]
    config = write(tmp_path, DROPS.replace("[0.2, 0.5, 0.8]", str(values)))
    lavendersim.run(config, root=tmp_path / "warm")
    monkeypatch.setattr(executor, "run_and_measure", dies_at_one_half)
    monkeypatch.setattr(executor, "WORTH_PROCESSES", 0.0)
    monkeypatch.setattr(executor, "BATCHES", 1)
    said: list[str] = []
    finished = lavendersim.run(
        config, root=tmp_path / "runs", jobs=2, progress=Progress(warning=said.append)
    )
    ended = {cell.label: cell.status for cell in finished.run.cells}
    died = {"e=0.5": "failed: its process was killed by SIGKILL, both times"}
    assert ended == {f"e={e}": "complete" for e in values} | died
    how = "was killed by SIGKILL"
    assert said == [
        f"the process of cells e=0.3 to e=0.5 {how}; these 3 cells are run once more",
        f"the process of cells e=0.3 to e=0.5 {how} again; each is run by itself",
        f"the process of cell e=0.5 {how}; the cell is run once more",
        f"the process of cell e=0.5 {how} again; the cell is given up",
    ]
