"""How far a run is: read at any time, from simulated steps, ended cells and the bytes on disk."""

from __future__ import annotations

from pathlib import Path
from threading import Event, Thread

import pytest

import lavendersim
from lavendersim.engine.engine import BLOCK_STEPS
from lavendersim.experiment import load_experiment_text
from lavendersim.runner import Progress
from lavendersim.runner.cell import CellJob
from lavendersim.runner.plans import shared_plans
from lavendersim.runner.progress import Moment, Tally
from tests.runner.small_configs import DROPS, write

LONG = DROPS.replace("duration: 0.5", "duration: 60").replace("[0.2, 0.5, 0.8]", "[0.2, 0.5]")


class Clock:
    """The time that a test sets."""

    def __init__(self) -> None:
        self.time = 0.0

    def __call__(self) -> float:
        return self.time


@pytest.fixture
def jobs(tmp_path: Path) -> list[CellJob]:
    """Two cells, of 100 steps of 1/100 s and of 300 of 1/300 s: one second each."""
    text = DROPS[: DROPS.index("sweep:")].replace("duration: 0.5", "duration: 1")
    text += "sweep:\n  dt: {path: numerics.timestep, values: [1/100, 1/300]}\n"
    cells = load_experiment_text(text.replace("chapter", "{preset: chapter}"), "x.yaml").cells()
    return [
        CellJob(cell.index, cell.config, "", tmp_path / f"{cell.index}.mcap", plan, "")
        for cell, plan in zip(cells, shared_plans(cells), strict=True)
    ]


def test_simulated_time_steps_and_bytes_are_those_of_the_cells(jobs: list[CellJob]) -> None:
    now = Clock()
    tally, done = Tally(jobs, now), 0
    before = tally.read()
    assert (before.cells, before.seconds, before.share) == (2, 2.0, 0.0)
    assert (before.label, before.remaining, before.written) == (None, None, 0)
    tally.begin(jobs[0], lambda: done)
    done, now.time = 50, 2.0
    jobs[0].path.write_bytes(bytes(1000))
    half = tally.read()
    assert half.label == "dt=1/100"
    assert (half.cell_seconds_done, half.cell_seconds, half.seconds_done) == (0.5, 1.0, 0.5)
    assert half.share == 50 / 400
    assert half.written == 1000
    # 50 steps in 2 s, so 350 in 14 s
    assert half.remaining == pytest.approx(14.0)
    now.time = 4.0
    tally.end(jobs[0])
    now.time = 100.0  # a kernel is compiled: no cell runs
    between = tally.read()
    assert (between.cells_done, between.label, between.seconds_done) == (1, None, 1.0)
    assert between.worked == 4.0
    # 100 steps in 4 s, so 300 in 12 s
    assert between.remaining == pytest.approx(12.0)


def test_a_cell_that_ends_while_somebody_reads_is_not_out_of_sight(jobs: list[CellJob]) -> None:
    """A reader that comes between the two things that are noted waits for both."""
    tally = Tally(jobs)
    tally.begin(jobs[0], lambda: 100)
    seen: list[Moment] = []
    reader = Thread(target=lambda: seen.append(tally.read()))

    class Ended(list[CellJob]):
        def append(self, job: CellJob) -> None:
            reader.start()
            reader.join(0.1)
            super().append(job)

    tally._ended = Ended()
    tally.end(jobs[0])
    reader.join()
    assert [one.share for one in seen] == [100 / 400]


def test_what_other_processes_take_is_estimated_from_their_own_speed(jobs: list[CellJob]) -> None:
    now = Clock()
    tally = Tally([*jobs, jobs[1]._replace(path=jobs[1].path.with_name("other"))], now)
    tally.begin(jobs[0], lambda: 100)
    now.time = 1000.0
    tally.end(jobs[0])
    tally.begin_in_others()
    assert tally.read().remaining is None
    now.time = 1003.0
    tally.end(jobs[1])
    # 300 steps in 3 s by the others; what this process took alone says nothing of the rest
    assert tally.read().remaining == pytest.approx(3.0)
    assert tally.read().worked == 1003.0


def test_a_running_cell_is_seen_within_a_call_of_the_kernel(tmp_path: Path) -> None:
    """What reads the steps is the engine's own counter: it grows by the step, not by the block."""
    tallies: list[Tally] = []
    seen: list[Moment] = []
    stopped = Event()

    def watch(tally: Tally) -> None:
        def read() -> None:
            while not stopped.wait(0.0002):
                seen.append(tally.read())

        tallies.append(tally)
        Thread(target=read, daemon=True).start()

    try:
        finished = lavendersim.run(
            write(tmp_path, LONG, "long.yaml"),
            root=tmp_path / "runs",
            progress=Progress(running=watch),
        )
    finally:
        stopped.set()
    shares = [moment.share for moment in seen]
    assert shares == sorted(shares)
    cell = finished.run.cells[0].trace()
    steps = {round(m.cell_seconds_done / float(cell.config.numerics.timestep)) for m in seen}
    assert any(done % BLOCK_STEPS for done in steps)
    (tally,) = tallies
    last = tally.read()
    assert (last.cells_done, last.share) == (2, 1.0)
    assert last.written == sum(cell.path.stat().st_size for cell in finished.run.cells)
