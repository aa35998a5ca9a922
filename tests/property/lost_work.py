"""How much of a simulation `kill -9` loses: what was done then, and is not in the log.

    python -m tests.property.lost_work --count 10 --seed 1

Piles of 1,000 and 2,000 spheres and a stack of six blocks run for long and are killed at random
times. While one runs, a thread of it says every 5 ms how many steps are done, and what the process
took of the processor; `recover` says which are in the log. Lost is what passed since the last of
them was done: on a machine with other work less of the processor than of the clock.
"""

from __future__ import annotations

import argparse
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

from lavendersim.trace import open_trace
from tests.cli.damaged_runs import verb

SCENES = Path(__file__).parents[2] / "configs" / "scenes"
CONFIGS = {
    "pile of 2000": ("pile.yaml", "counts: [8, 5, 25]", "counts: [8, 5, 50]", 4.0),
    "pile of 1000": ("pile.yaml", "", "", 4.0),
    "stack of six": ("stack_of_six.yaml", "", "", 5.0),
}
SCRIPT = """
import sys, threading, time
from lavendersim.runner import cell
import lavendersim
simulate = cell._simulate

def said(began):
    def begin(done):
        if began is not None:
            began(done)
        def say():
            while True:
                print(time.monotonic(), time.process_time(), done(), flush=True)
                time.sleep(0.005)
        threading.Thread(target=say, daemon=True).start()
    return begin

cell._simulate = lambda jobs, began, *more: simulate(jobs, said(began), *more)
lavendersim.run(sys.argv[1], root=sys.argv[2])
"""
LONGER = 1000.0  # times the duration: none ends before it is killed
SLOWEST = 1.0  # [s] a step for which the bar holds


class Lost(NamedTuple):
    """What one kill lost."""

    simulated: int  # steps
    saved: int  # steps
    processor: float  # [s] since the last saved step was done
    clock: float  # [s] the same


def written(folder: Path, name: str) -> Path:
    """Write a config that runs for long; returns its file."""
    file, old, new, duration = CONFIGS[name]
    text = (SCENES / file).read_text(encoding="utf-8")
    asked = f"duration: {duration}"
    assert old in text
    assert asked in text
    text = text.replace(old, new).replace(asked, f"duration: {LONGER * duration}")
    config = folder / f"{name.replace(' ', '_')}.yaml"
    config.write_text(text, encoding="utf-8")
    return config


def killed(config: Path, folder: Path, wait: float) -> Lost:
    """Kill a run so long after its first step."""
    arguments = [sys.executable, "-c", SCRIPT, str(config), str(folder)]
    process = subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    said: list[str] = []
    first = threading.Event()

    def read(lines: list[str] = said) -> None:
        for line in process.stdout or ():
            if line.endswith("\n"):
                lines.append(line)
                if not line.endswith(" 0\n"):
                    first.set()

    reader = threading.Thread(target=read)
    reader.start()
    assert first.wait(timeout=600.0)
    time.sleep(wait)
    process.send_signal(signal.SIGKILL)
    end = time.monotonic()
    reader.join()
    process.wait()
    clock, processor, steps = np.array([[float(one) for one in line.split()] for line in said]).T
    saved = _saved(folder)
    reached = int(np.argmax(steps >= saved))
    return Lost(
        int(steps[-1]), saved, processor[-1] - processor[reached], end - float(clock[reached])
    )


def _saved(folder: Path) -> int:
    [log] = folder.glob("*/cells/*.mcap")
    done = verb("recover", log, "--output", folder / "saved.mcap")
    if done.code == 5:
        return 0
    assert done.code == 3, done
    return int(open_trace(folder / "saved.mcap", allow_incomplete=True).step["step"].max())


def main() -> None:
    """Kill as many runs of each as are asked for; exits 1 where more than a second is lost."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--longest", type=float, default=6.0, help="[s] of a run")
    asked = parser.parse_args()
    draw, bad = random.Random(asked.seed), False
    for name in CONFIGS:
        lost = []
        for _ in range(asked.count):
            with tempfile.TemporaryDirectory() as folder:
                config = written(Path(folder), name)
                lost.append(killed(config, Path(folder) / "runs", draw.uniform(0.1, asked.longest)))
        worst = max(lost, key=lambda one: one.processor)
        bad |= worst.processor > SLOWEST
        print(
            f"{name}: {len(lost)} killed; lost at most {worst.processor:.2f} s of the processor"
            f" ({worst.clock:.2f} s of the clock): {worst.simulated - worst.saved} of"
            f" {worst.simulated} steps; most by the clock {max(one.clock for one in lost):.2f} s",
            flush=True,
        )
    sys.exit(bad)


if __name__ == "__main__":
    main()
