"""Runs that are killed at random moments: what is left of them, and what they become.

    python -m tests.property.killed_runs --count 100 --seed 1             each is resumed
    python -m tests.property.killed_runs --count 300 --seed 1 --verbs     and read before that

Each is killed with SIGKILL, the process that was started alone: its workers have to end by
themselves. Prints what is wrong, a line each, and how many were killed where. The suite does a few.
"""

from __future__ import annotations

import argparse
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import psutil
from typer.testing import CliRunner

from lavendersim.errors import LavenderError
from lavendersim.runner import Run, executor, list_runs, open_run, run
from tests.drop_config import LOW
from tests.runner.run_contents import contents

MANY = f"""\
{LOW}duration: 0.5
sweep:
  e:
    path: scene.bodies.ball.surface.restitution
    values: {[round(0.1 + i / 100, 2) for i in range(60)]}
measure: {{rebound: {{kind: first_apex, body: ball, above: floor}}}}
expect: [{{name: rebound, measure: rebound, increasing: {{along: e}}}}]
"""
# Cells that break a bound have to end as they did: at their first contact, 30 um deep.
BOUNDED = MANY + "always: {penetration: 1.0e-9}\n"
# Cells of two products that are the same simulation have one log.
SHARED = f"""\
{LOW}duration: 0.5
sweep:
  - {{e: {{path: scene.bodies.ball.surface.restitution, values: [0.2, 0.3, 0.4]}}}}
  - mass: {{path: scene.bodies.ball.mass, values: [1, 2]}}
    e: {{path: scene.bodies.ball.surface.restitution, values: [0.5, 0.6]}}
measure: {{rebound: {{kind: first_apex, body: ball, above: floor}}}}
"""
SPREAD = """\
scene:
  bodies: {floor: {shape: {kind: plane}}}
  arrangements:
    ball:
      kind: grid
      counts: [2, 2, 1]
      origin: [0, 0, 0.3]
      jitter: 0.01
      seed: 3
      spacing: [0.3, 0.3, 0.3]
      body: {shape: {kind: sphere, radius: 0.1}, mass: 1.0}
numerics: {preset: chapter, timestep: 1/60}
duration: 0.5
sweep: {h: {path: numerics.timestep, values: [1/60, 1/120, 1/240, 1/480, 1/960, 1/1920]}}
measure: {drift: {kind: drift}}
"""
LONG = f"{LOW}duration: 60\nmeasure: {{drift: {{kind: drift}}}}\n"
PARTLY = SPREAD.replace(
    "measure: {drift: {kind: drift}}",
    "record: {poses: {from: 0, to: 0.2}, contacts: {from: 0, to: 0.2}}",
)
CONFIGS = {"many": MANY, "bounded": BOUNDED, "spread": SPREAD}
READ = CONFIGS | {"shared": SHARED, "long": LONG, "partly": PARTLY}
SCRIPT = """
import sys
import lavendersim.runner.executor as executor
import lavendersim
if __name__ == "__main__":
    executor.WORTH_PROCESSES = -1.0
    print(flush=True)
    lavendersim.run(sys.argv[1], root=sys.argv[2], jobs=int(sys.argv[3]))
"""
PATIENCE = 10.0  # [s] in which workers of a killed process end, on a machine with other work


class Case(NamedTuple):
    """A config whose runs are killed: what its run holds that is not, and how long it takes."""

    config: Path
    whole: dict[str, Any]
    seconds: float


def prepared(folder: Path, name: str, text: str) -> Case:
    """Write a config into a folder, and run it twice: kernels are there the second time."""
    config = folder / f"{name}.yaml"
    config.write_text(text)
    whole = contents(run(config, folder / "whole").run)
    begin = time.perf_counter()
    run(config, folder / "whole")
    return Case(config, whole, time.perf_counter() - begin)


def killed(folder: Path, config: Path, jobs: int, wait: float) -> tuple[Path, list[int]]:
    """Kill a run so long after its first cell began.

    Returns the folder of its runs, and the processes that it leaves.
    """
    script, runs = folder / "script.py", folder / "runs"
    script.write_text(SCRIPT)
    before = {path.parent for path in runs.glob("*/cells.json")}
    arguments = [sys.executable, script, config, runs, jobs]
    process = subprocess.Popen([str(one) for one in arguments], stdout=subprocess.PIPE)
    while process.poll() is None and {p.parent for p in runs.glob("*/cells.json")} == before:
        time.sleep(0.001)
    time.sleep(wait)
    try:
        others = psutil.Process(process.pid).children(recursive=True)
    except psutil.NoSuchProcess:
        others = []
    process.send_signal(signal.SIGKILL)
    process.communicate()
    _, alive = psutil.wait_procs(others, timeout=PATIENCE)
    for one in alive:
        one.kill()
    return runs, [one.pid for one in alive]


def wrong_when_resumed(case: Case, folder: Path, jobs: int, wait: float) -> Iterator[str]:
    """Yield what is wrong after a kill and a resumption."""
    runs, alive = killed(folder, case.config, jobs, wait)
    if alive:
        yield f"processes are left: {alive}"
    if contents(run(case.config, runs, jobs, resume=True).run) != case.whole:
        yield "the resumed run holds something else"


def wrong_when_read(case: Case, folder: Path, how: tuple[int, float, bool]) -> Iterator[str]:
    """Yield what is wrong after a kill when the run is read, recovered, verified, and run again.

    how: jobs, when it is killed [s], and whether it is then resumed or a new one begins.
    """
    jobs, wait, resume = how
    earlier = run(case.config, folder / "runs").run
    runs, alive = killed(folder, case.config, jobs, wait)
    if alive:
        yield f"processes are left: {alive}"
    if open_run(None, runs).path.resolve() not in {p.path.resolve() for p in finished(runs)}:
        yield "latest is no finished run"
    found = list_runs(runs)
    left = found[-1]
    for verb, codes in (
        (("ls", "--runs", runs), {0}),
        (("show", "--runs", runs), {0}),
        (("show", left.path), {0} if left.finished else {2, 3}),
        (("verify", earlier.path), {0}),
        (("verify", left.path), {0} if left.finished else {0, 2, 3}),
    ):
        yield from wrong_verb(codes, *verb)
    yield from wrong_when_recovered(left, folder / "copy")
    last = run(case.config, runs, jobs, resume=resume and not left.finished).run
    if contents(last) != case.whole:
        yield "the run after it holds something else"
    if contents(earlier) != case.whole:
        yield "the run before it has changed"
    if resume and (hidden := half_written(runs)):
        yield f"left: {hidden}"
    yield from wrong_verb({0}, "verify", last.path)


def wrong_when_recovered(left: Run, copy: Path) -> Iterator[str]:
    """Yield what is wrong after a copy of a run is recovered; the copy is there afterwards."""
    shutil.copytree(left.path, copy, symlinks=True)
    logs = {path: path.read_bytes() for path in copy.glob("cells/*.mcap")}
    if logs:
        yield from wrong_verb({0, 3, 5}, "recover", copy)
    if any(path.read_bytes() != data for path, data in logs.items()):
        yield "recover changed a log"


def half_written(runs: Path) -> list[Path]:
    """Return the files below a folder of runs that are written aside, but for locks."""
    return [path for path in runs.rglob(".*") if path.name != ".lock"]


def finished(runs: Path) -> list[Run]:
    """Return the runs that came to their end."""
    return [one for one in list_runs(runs) if one.finished]


def wrong_verb(codes: set[int], *arguments: object) -> Iterator[str]:
    """Yield what is wrong with a command that is to exit with one of these codes."""
    from lavender_cli.main import app

    done = CliRunner().invoke(app, [str(one) for one in arguments])
    code = done.exit_code
    if isinstance(done.exception, LavenderError):
        code = done.exception.exit_code
    elif done.exception is not None and not isinstance(done.exception, SystemExit):
        yield f"{arguments[0]}: {done.exception!r}"
        return
    if code not in codes:
        yield f"{arguments[0]}: exits {code}: {done.output}"


def main() -> None:
    """Kill as many runs as are asked for; exits 1 where something is wrong."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--verbs", action="store_true", help="six configs, 1 to 3 jobs, all verbs")
    asked = parser.parse_args()
    executor.WORTH_PROCESSES = -1.0
    draw = random.Random(asked.seed)
    texts = READ if asked.verbs else CONFIGS
    bad = 0
    states: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as top:
        cases = {}
        for name, text in texts.items():
            (Path(top) / name).mkdir()
            cases[name] = prepared(Path(top) / name, name, text)
        for number in range(asked.count):
            name = [*cases][number % len(cases)]
            case = cases[name]
            jobs = draw.randint(1, 3 if asked.verbs else 2)
            wait, resume = draw.uniform(0.0, 1.2 * case.seconds), draw.random() < 0.5
            folder = Path(top) / f"{number}"
            folder.mkdir()
            if asked.verbs:
                said = [*wrong_when_read(case, folder, (jobs, wait, resume))]
            else:
                said = [*wrong_when_resumed(case, folder, jobs, wait)]
            states[f"{name}, {jobs} jobs"] += 1
            for one in said:
                print(f"{number}: {name}, {jobs} jobs, {wait:.3f} s: {one}", flush=True)
            bad += bool(said)
            shutil.rmtree(folder)
    for what, count in sorted(states.items()):
        print(f"{what}: {count}")
    print(f"{asked.count} killed, {bad} with something wrong")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
