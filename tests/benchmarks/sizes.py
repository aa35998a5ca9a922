"""What large scenes, sweeps and logs cost: time and memory of whole commands.

    python -m tests.benchmarks.sizes [--share 0.1] [--repeats 3] [--output FILE.json] [--check]

Every sample is one command in a process of its own: time on the clock from its start to its end,
and the most memory that was resident. Kernels are on disk from a first run that is not counted.
With --share every size is that share of its own; with --check the exit code is 1 when a median is
above its bar, which holds for a share of 1 alone.

| case | bars |
|---|---|
| plan of 100,000 bodies: a heap of spheres that touch | 5 s |
| plan of 100,000 cells: drops by restitution and clearance | 10 s, 300 MB |
| plan of 100,000 cells: drops by mass and restitution, with measures and a claim | 10 s, 300 MB |
| first step of 20,000 bodies, logged and judged | 30 s, 600 MB |
| 2,000,000 steps of one ball judged again, from the log | memory as for a tenth of them |
| 1,000 and 5,000 short drops run, measured and judged | 12 kB a cell more |
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Final, NamedTuple

from tests.benchmarks.line_cases import RESTITUTIONS, lasting
from tests.benchmarks.line_cases import drops as line_drops


class Case(NamedTuple):
    """A command and its bars: [s], [MB]; None: none."""

    name: str
    config: str
    verbs: tuple[tuple[str, ...], ...]  # the last one is measured
    seconds: float | None = None
    megabytes: float | None = None


HEAP: Final = """scene:
  bodies:
    floor: {{shape: {{kind: plane}}, surface: {{friction: 0.5}}}}
  arrangements:
    ball:
      kind: grid
      counts: [{rows}, {rows}, {layers}]
      spacing: [0.1, 0.1, 0.1]
      origin: [0, 0, 0.05]
      body: {{shape: {{kind: sphere, radius: 0.05}}, density: 1000, surface: {{friction: 0.5}}}}
duration: {duration}
always: {{residual: none}}
"""
DROPS: Final = """scene:
  bodies:
    floor: {{shape: {{kind: plane}}}}
    ball:
      shape: {{kind: sphere, radius: 0.1}}
      mass: 1
      release: {{above: floor, clearance: 1}}
duration: 1
sweep:
  e: {{path: scene.bodies.ball.surface.restitution, values: {restitutions}}}
  h: {{path: scene.bodies.ball.release.clearance, values: {clearances}}}
always: {{}}
"""
# Of which a cell more is asked for what it takes; 24 steps each.
FEW, MANY = 1000, 5000
MOST_OF_CELL: Final = 12.0  # [kB]
BALL: Final = """scene:
  bodies:
    floor: {{shape: {{kind: plane}}}}
    ball: {{shape: {{kind: sphere, radius: 0.05}}, mass: 1, position: [0, 0, 0.05]}}
numerics: {{timestep: 1/1000}}
duration: {duration}
always: {{}}
"""


def short_drops(cells: int) -> str:
    """Return the config of so many drops that rebound within 0.1 s."""
    return lasting(line_drops(cells), "0.1").replace("clearance: 1.0", "clearance: 0.01")


def cases(share: float) -> list[Case]:
    """Return the cases; share: of their sizes."""
    across, along = max(round(100 * share**0.5), 1), max(round(1000 * share**0.5), 1)
    deep = HEAP.format(rows=across, layers=10, duration=1)
    heap = HEAP.format(rows=max(round(31.6 * share**0.5), 1), layers=20, duration="0.004")
    drops = DROPS.format(
        restitutions=[round(k / 200, 4) for k in range(across)],
        clearances=[round(0.5 + k / 1000, 4) for k in range(along)],
    )
    judged = (("run",), ("judge", "latest"))
    heavy = line_drops(max(round(5000 * share), 1) * RESTITUTIONS)
    few, many = (
        short_drops(max(round(cells * share / RESTITUTIONS), 1) * RESTITUTIONS)
        for cells in (FEW, MANY)
    )
    return [
        Case("plan of 100,000 bodies", deep, (("plan",),), seconds=5.0),
        Case("plan of 100,000 cells", drops, (("plan",),), seconds=10.0, megabytes=300.0),
        Case("plan of 100,000 masses", heavy, (("plan",),), seconds=10.0, megabytes=300.0),
        Case("first step of 20,000 bodies", heap, (("run",),), seconds=30.0, megabytes=600.0),
        Case("200,000 steps judged", BALL.format(duration=200 * share), judged),
        Case("2,000,000 steps judged", BALL.format(duration=2000 * share), judged),
        Case(f"{FEW:,} drops", few, (("run",),)),
        Case(f"{MANY:,} drops", many, (("run",),)),
    ]


def command(folder: Path, *words: str) -> tuple[float, float]:
    """Run a command in a folder; returns what it took [s] and its most resident memory [MB]."""
    begin = perf_counter()
    child = os.fork()
    if child == 0:
        os.chdir(folder)
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.execv(sys.executable, [sys.executable, "-m", "lavender_cli.main", *words])
    _, status, used = os.wait4(child, 0)
    if os.waitstatus_to_exitcode(status) != 0:
        raise SystemExit(f"lavender {' '.join(words)} failed in {folder}")
    return perf_counter() - begin, used.ru_maxrss / 1000.0


def samples(case: Case, repeats: int) -> list[tuple[float, float]]:
    """Return the samples of a case: seconds and megabytes each."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "case.yaml").write_text(case.config)

        def verb(words: tuple[str, ...]) -> tuple[float, float]:
            return command(folder, words[0], *(words[1:] or ("case.yaml",)))

        *before, measured = case.verbs
        if measured[0] == "run":  # the first one compiles
            before = [measured]
        for words in before:
            verb(words)
        return [verb(measured) for _ in range(repeats)]


def missed(case: Case, found: list[tuple[float, float]]) -> list[str]:
    """Return a sentence for each bar that a median is above."""
    seconds, megabytes = (median(one) for one in zip(*found, strict=True))
    bars = ((seconds, case.seconds, "s"), (megabytes, case.megabytes, "MB"))
    return [
        f"{case.name}: {value:.1f} {unit}, at most {bar:g}"
        for value, bar, unit in bars
        if bar is not None and value > bar
    ]


def main() -> None:
    """Print a table, write every sample, and hold the bars where that is asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--share", type=float, default=1.0)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--output", type=Path)
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    table, above = {}, []
    print(f"{'case':30} {'s':>8} {'MB':>8}")
    for case in cases(options.share):
        found = samples(case, options.repeats)
        seconds, megabytes = (median(one) for one in zip(*found, strict=True))
        print(f"{case.name:30} {seconds:8.1f} {megabytes:8.0f}", flush=True)
        table[case.name] = found
        above += missed(case, found)
    few, many = (table[name] for name in ("200,000 steps judged", "2,000,000 steps judged"))
    flat = median(one for _, one in many) / median(one for _, one in few)
    print(f"memory of ten times the steps: {flat:.2f} times")
    few, many = (median(one for _, one in table[f"{name:,} drops"]) for name in (FEW, MANY))
    cell = (many - few) * 1000.0 / ((MANY - FEW) * options.share)
    print(f"memory of a cell more: {cell:.1f} kB")
    if cell > MOST_OF_CELL:
        above.append(f"a cell more: {cell:.1f} kB, at most {MOST_OF_CELL:g}")
    if options.output:
        options.output.write_text(json.dumps({"share": options.share, "samples": table}, indent=1))
    if options.check and above:
        raise SystemExit("\n".join(above))


if __name__ == "__main__":
    main()
