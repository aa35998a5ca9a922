"""How many worlds a machine steps in a second, from config to verdict: one process against two.

    python -m tests.benchmarks.worlds [--share 1] [--repeats 3] [--check] [--apart]
                                      [--output FILE.json]

A world is one cell of a sweep whose cells differ in numbers alone: 10,000 drops of one second, and
2,000 stacks of six blocks. Each is planned, stepped, logged, measured and judged, with one process
and with PROCESSES, interleaved; kernels are on disk before. The number is worlds times steps a
second of wall time, and the ratio of the two is what --check holds to BAR (exit code 1 below it).

Other work on the same cores makes wall times of two processes longer than those of one. Therefore
the ratio that processor times allow stands beside it: what one process takes, over what two take
where nobody else asks for the cores. Before the first cell begins and after the last has ended one
process works alone, between them the cores share what there is to do. A quiet machine does no
better. Whatever else runs makes times longer, never shorter: of the repeats the least counts.

--apart: runs of one process, as many beside each other as there are PROCESSES, that know nothing of
one another. Where a cell of theirs takes longer than of one run alone, that is the machine: caches,
memory and cores that are shared with others.

In one call: the same worlds as engines that advance together (`engine.worlds`), stepped and not
logged, by one thread and by as many as there are processes; at most MOST of a kind, as they are all
in memory.

--share: of the numbers of cells; what starting processes takes weighs more in fewer cells, and
where all of them are too short for it (`executor.WORTH_PROCESSES`) none is started.
"""

from __future__ import annotations

import argparse
import json
import resource
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

from lavendersim.engine.engine import Engine
from lavendersim.engine.worlds import Worlds
from lavendersim.experiment import load_experiment_text
from lavendersim.runner import Progress, run
from lavendersim.runner.environment import environment
from lavendersim.runner.workers import work
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of_cell

from .folders import new_folder
from .line_cases import RESTITUTIONS, drops

PROCESSES = 2
BAR = 1.8  # times the throughput of one process
MOST = {"drops": 200, "stacks of six": 40}  # worlds in one call: some 60 MB
DROPS, STACKS = 10_000, 2_000  # cells
# Masses scale every impulse, so no two stacks are the same simulation.
STACK = """\
scene:
  surfaces: {frictional: {friction: 0.5}}
  bodies:
    floor: {shape: {kind: plane}, surface: frictional}
  arrangements:
    block:
      kind: tower
      count: 6
      body: {shape: {kind: box, size: [0.2, 0.2, 0.2]}, mass: 1.0, surface: frictional}
numerics: {timestep: 1/240}
duration: 1.0
sweep: {mass: {path: scene.arrangements.block.body.mass, values: [MASSES]}}
always: {}
measure:
  drift: {kind: drift, after: 0.1}
expect:
  - {name: no block drifts, measure: drift, at_most: 1e-6}
"""


class Taken(NamedTuple):
    """What one run took."""

    worlds: int
    steps: int  # of all worlds
    wall: float  # [s]
    own: float  # [s] of processor, of the process that plans and judges
    others: float  # [s] of processor, of the processes that it started
    serial: float = 0.0  # [s] of `own` before the first cell and after the last

    @property
    def throughput(self) -> float:
        """Worlds times steps a second [1/s]."""
        return self.steps / self.wall

    def shortest(self, processes: int) -> float:
        """Return the least wall time [s] that processor times allow on as many cores."""
        together = self.own + self.others - self.serial
        return self.serial + max(together / processes, self.own - self.serial)


def stacks(cells: int) -> str:
    """Return the config of a sweep of stacks of six."""
    return STACK.replace("MASSES", ", ".join(f"{1 + k / 1000:.3f}" for k in range(cells)))


def cases(share: float) -> dict[str, str]:
    """Return the configs by name."""
    rows = max(round(DROPS * share) // RESTITUTIONS, 1)
    return {
        "drops": drops(rows * RESTITUTIONS),
        "stacks of six": stacks(max(round(STACKS * share), 1)),
    }


def processor(who: int) -> float:
    """Return the processor time [s] of this process or of its children that have ended."""
    used = resource.getrusage(who)
    return used.ru_utime + used.ru_stime


def taken(text: str, processes: int) -> Taken:
    """Run a config in a new folder."""
    experiment = load_experiment_text(text, "worlds.yaml")
    times: list[float] = []  # of this process, as the first cell begins and as the last has ended

    def note(*of_cells: Any) -> None:
        if len(of_cells) != 2 or of_cells[0] == of_cells[1]:
            times.append(processor(resource.RUSAGE_SELF))

    folder = new_folder()
    before = processor(resource.RUSAGE_SELF), processor(resource.RUSAGE_CHILDREN)
    begin = perf_counter()
    finished = run(experiment, folder, processes, Progress(running=note, cell_done=note))
    wall = perf_counter() - begin
    after = processor(resource.RUSAGE_SELF)
    own = after - before[0]
    others = processor(resource.RUSAGE_CHILDREN) - before[1]
    if not finished.good:
        raise SystemExit(f"{experiment.name}: {processes} processes: a claim is not met")
    steps = sum(outcome.steps for outcome in finished.outcomes)
    serial = times[0] - before[0] + after - times[1]
    return Taken(len(finished.outcomes), steps, wall, own, others, serial)


def engines_of(text: str, most: int) -> list[Engine]:
    """Return an engine of each of the first cells of a config, at its start."""
    cells = load_experiment_text(text, "worlds.yaml").cells()[:most]
    spec = plan_of_cell(cells[0]).spec
    return [build(cell.config, spec).engine(spec, cell.config.steps + 1) for cell in cells]


def in_one_call(text: str, most: int, repeats: int) -> tuple[float, float]:
    """Return worlds times steps a second [1/s] of one thread and of PROCESSES."""
    best = [0.0, 0.0]
    for _ in range(repeats):
        for at, threads in enumerate((1, PROCESSES)):
            engines = engines_of(text, most)
            worlds = Worlds(engines)
            worlds.advance(0)
            begin = perf_counter()
            worlds.advance(240, threads)
            spent = perf_counter() - begin
            steps = sum(int(engine.counters["step"][0]) for engine in engines)
            best[at] = max(best[at], steps / spent)
    return best[0], best[1]


def alone(text: str) -> Taken:
    """Run a config with one process."""
    return taken(text, 1)


def apart(text: str, repeats: int) -> float:
    """Return the processor time [ms] of a cell in runs beside each other."""
    return min(
        1e3 * one.own / one.worlds
        for _ in range(repeats)
        for _, one in work(alone, [text] * PROCESSES, PROCESSES)
        if isinstance(one, Taken)
    )


def measure(configs: dict[str, str], repeats: int) -> dict[str, list[tuple[Taken, Taken]]]:
    """Run every config with one process and with PROCESSES, in turn; pairs by name."""
    found: dict[str, list[tuple[Taken, Taken]]] = {name: [] for name in configs}
    for name, text in cases(0.0).items():  # compiles, and imports
        if name in configs:
            taken(text, 1)
    for repeat in range(repeats):
        for name, text in configs.items():
            order = (1, PROCESSES) if repeat % 2 == 0 else (PROCESSES, 1)
            by_processes = {processes: taken(text, processes) for processes in order}
            found[name].append((by_processes[1], by_processes[PROCESSES]))
    return found


def ratios(pairs: Sequence[tuple[Taken, Taken]]) -> tuple[float, float]:
    """Return how many times the throughput of one process is had: by wall and by processor."""
    ones, manys = zip(*pairs, strict=True)
    return (
        max(many.throughput for many in manys) / max(one.throughput for one in ones),
        min(one.shortest(1) for one in ones) / min(many.shortest(PROCESSES) for many in manys),
    )


def lines_of(found: dict[str, list[tuple[Taken, Taken]]]) -> Iterator[str]:
    """Yield a table: throughputs, ratios, and the processor time of a cell."""
    yield (
        f"{'':14} {'worlds':>7} {'steps each':>10} {'1 process':>10} {PROCESSES:>3} processes  /s"
        f" {'ratio':>6} {'by processor':>12} {'ms a cell':>10} {f'with {PROCESSES}':>7}"
    )
    for name, pairs in found.items():
        one, many = pairs[0]
        slow, fast = (max(pair[at].throughput for pair in pairs) for at in (0, 1))
        wall, allowed = ratios(pairs)
        alone, shared = (
            min((pair[at].own + pair[at].others) / pair[at].worlds for pair in pairs) * 1e3
            for at in (0, 1)
        )
        yield (
            f"{name:14} {one.worlds:7} {one.steps / one.worlds:10.0f} {slow:10.0f} {fast:17.0f}"
            f" {wall:6.2f} {allowed:12.2f} {alone:10.2f} {shared:7.2f}"
        )
        assert many.steps == one.steps


def missed(found: dict[str, list[tuple[Taken, Taken]]]) -> list[str]:
    """Return a sentence for each case whose ratio of wall times is below the bar."""
    by_wall = {name: ratios(pairs)[0] for name, pairs in found.items()}
    return [
        f"{name}: {ratio:.2f} times the throughput of one process, at least {BAR}"
        for name, ratio in by_wall.items()
        if ratio < BAR
    ]


def main() -> int:
    """Read the command line, measure, print, write."""
    parser = argparse.ArgumentParser(description="Worlds times steps a second.")
    parser.add_argument("--share", type=float, default=1.0, help="of the numbers of cells")
    parser.add_argument("--repeats", type=int, default=3, help="interleaved rounds")
    parser.add_argument("--output", type=Path, help="JSON file for all samples")
    parser.add_argument("--check", action="store_true", help="exit 1 below the bar")
    parser.add_argument("--apart", action="store_true", help="runs that share nothing, too")
    arguments = parser.parse_args()
    found = measure(cases(arguments.share), arguments.repeats)
    print("\n".join(lines_of(found)))
    for name, text in cases(arguments.share).items() if arguments.apart else ():
        print(f"{name:14} {PROCESSES} runs apart: {apart(text, arguments.repeats):.2f} ms a cell")
    for name, text in cases(arguments.share).items():
        one, more = in_one_call(text, MOST[name], arguments.repeats)
        print(f"{name:14} in one call, stepped alone {one:19.0f} {more:17.0f} {more / one:6.2f}")
    if arguments.output:
        samples: dict[str, Any] = {
            name: [[one._asdict(), many._asdict()] for one, many in pairs]
            for name, pairs in found.items()
        }
        table = {"share": arguments.share, "samples": samples, "environment": environment()}
        arguments.output.write_text(json.dumps(table, indent=1) + "\n")
    below = missed(found)
    print("\n".join(below))
    return 1 if arguments.check and below else 0


if __name__ == "__main__":
    sys.exit(main())
