"""How long a run takes until its first step: a table and a JSON file with every sample.

    python -m tests.benchmarks.first_result [CONFIG...] [--repeats 3] [--output FILE.json] [--check]

Every sample is a `lavender run` in a process of its own. `imports` loads every module it needs;
`warm start` is all the rest up to the first step, with the kernel on disk; `cold compile` is what
the first call of the kernel takes when there is none. Without configs, those of the chapter.
With --check the exit code is 1 when a median is above its bar.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

ROOT = Path(__file__).parents[2]
WARM_BAR, COLD_BAR = 0.3, 12.0  # [s], on two cores
KINDS = ("imports", "warm start", "cold compile")
BARS = {"warm start": WARM_BAR, "cold compile": COLD_BAR}
# What `lavender run` imports late, so that other verbs are quick.
LATE = (
    "lavendersim.engine.engine",
    "lavendersim.measures",
    "lavendersim.runner.cell",
    "lavendersim.runner.executor",
    "lavendersim.runner.plans",
)


def run_once(config: Path, root: Path) -> dict[str, float]:
    """Run a config in this process; returns what came before the first step [s]."""
    begin = perf_counter()
    main = importlib.import_module("lavender_cli.main").main
    for name in LATE:
        importlib.import_module(name)
    imported = perf_counter()
    engine = importlib.import_module("lavendersim.engine.engine").Engine
    advance = engine.advance
    calls: list[tuple[float, float]] = []

    def timed_advance(self: Any, steps: int) -> int:
        start = perf_counter()
        status = int(advance(self, steps))
        calls.append((start, perf_counter()))
        return status

    engine.advance = timed_advance
    sys.argv = ["lavender", "run", str(config), "--runs", str(root)]
    try:
        main()
    except SystemExit as done:
        if done.code:
            raise
    start, end = calls[0]
    return {"imports": imported - begin, "first call": end - start, "first step": end - imported}


def sample(config: Path, root: Path, cache: Path) -> dict[str, float]:
    """Return what `run_once` finds in a new process."""
    done = subprocess.run(
        [sys.executable, "-m", "tests.benchmarks.first_result", str(config), "--once", str(root)],
        cwd=ROOT,
        env=os.environ | {"LAVENDER_CACHE_DIR": str(cache)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    found: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return found


def measure(configs: list[Path], repeats: int) -> dict[str, Any]:
    """Time every config `repeats` times, interleaved, each time from an empty cache."""
    from lavendersim.runner.environment import machine

    samples: dict[str, dict[str, list[float]]] = {
        config.name: {kind: [] for kind in KINDS} for config in configs
    }
    for _ in range(repeats):
        for config in configs:
            with tempfile.TemporaryDirectory() as folder:
                root, cache = Path(folder) / "runs", Path(folder) / "kernels"
                cold, warm = (sample(config.resolve(), root, cache) for _ in range(2))
            row = samples[config.name]
            row["imports"].append(warm["imports"])
            row["warm start"].append(warm["first step"])
            row["cold compile"].append(cold["first call"])
    return {
        "unit": "s",
        "repeats": repeats,
        "bars": BARS,
        "machine": machine(),
        "medians": {
            name: {kind: median(row[kind]) for kind in KINDS} for name, row in samples.items()
        },
        "samples": samples,
    }


def over(found: dict[str, Any]) -> list[str]:
    """Return which config is above which bar, in words."""
    return [
        f"{name}: {kind} {row[kind]:.2f} s, bar {bar:g} s"
        for name, row in found["medians"].items()
        for kind, bar in found["bars"].items()
        if row[kind] > bar
    ]


def table(found: dict[str, Any]) -> str:
    """Return the medians as a small table, the longest compilation last."""
    rows = sorted(found["medians"].items(), key=lambda item: item[1]["cold compile"])
    lines = [f"{'':32}" + "".join(f"{kind:>14}" for kind in KINDS) + "   s"]
    lines += [f"{name:32}" + "".join(f"{row[kind]:14.3f}" for kind in KINDS) for name, row in rows]
    return "\n".join([*lines, f"{'bar':32}{'':14}{WARM_BAR:14g}{COLD_BAR:14g}"])


def main() -> int:
    """Read the command line, measure, print, write."""
    parser = argparse.ArgumentParser(description="How long until the first step.")
    parser.add_argument("configs", nargs="*", type=Path, help="config files; else the chapter's")
    parser.add_argument("--repeats", type=int, default=3, help="interleaved rounds")
    parser.add_argument("--output", type=Path, help="JSON file for medians and all samples")
    parser.add_argument("--check", action="store_true", help="exit 1 above a bar")
    parser.add_argument("--once", type=Path, help=argparse.SUPPRESS)  # one sample; where to run
    arguments = parser.parse_args()
    if arguments.once:
        print(json.dumps(run_once(arguments.configs[0], arguments.once)))
        return 0
    configs = arguments.configs or sorted((ROOT / "configs" / "chapter").glob("*.yaml"))
    found = measure(configs, arguments.repeats)
    print(table(found))
    if arguments.output:
        arguments.output.write_text(json.dumps(found, indent=1) + "\n")
    late = over(found)
    if arguments.check:
        print("\n".join(late))
    return 1 if arguments.check and late else 0


if __name__ == "__main__":
    sys.exit(main())
