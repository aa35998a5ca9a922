"""Random configs on the fullest engines and on drawn ones; says what broke, and keeps it.

    python tests/property/fuzz.py --runs 10000 --plans 20 --jobs 2 --keep finds

Every run is one of `fuzz_laws.judged`. All engines have as many of the `--runs`: the one with every
effect and pair of shapes, the one whose laws joints can be with, the one that is asked for an
accuracy, and so many drawn `--plans`;
`--only full plan_3` picks some. Each run is drawn from a seed of its own, so that it is known by
its number. An engine is one process: where that ends, or a run does not, this run is a find, and
the next process goes on behind it. The directory `--keep` has a line for every hundred runs, in
`finished.csv`: started again, the program goes on behind them; `--report` says what stands there,
and runs nothing. It also has each config that breaks a law, as a config that replays it. Exit 1
where anything broke.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple

from fuzz_draws import Draw
from fuzz_laws import ENDLESS, judged, loaded, run, text_of
from fuzz_scenes import ACCURATE, FULL, JOINED, Drawn, config_of, plan_of

# One run in ten of some plans takes seconds, nine tenths of the time of all: it is judged over as
# many of its steps as take that long, one by one, by every law. Tests judge runs whole.
ENOUGH = 0.3  # [s] of the processor
CHUNK = 100  # runs of a line: what an interruption loses at most
LAWS = ("ended", "diverged", "push", "momentum", "gap", "penetration", "energy", "units")
HEADING = ("engine", "seed", "first", "runs", "finds", "seconds", *LAWS)
GOES_ON = 3  # exit code of a process that left a run behind which does not end


class Find(NamedTuple):
    """A config that breaks laws, and which."""

    tree: dict[str, Any]
    laws: list[str]


def drawn_plans(count: int, seed: int = 0) -> list[Drawn]:
    """Return so many different plans."""
    different: dict[str, Drawn] = {}
    for number in range(2 * count):
        plan = plan_of(Draw(f"plan {seed} {number}"))
        different.setdefault(repr(plan), plan)
    return list(different.values())[:count]


def drawn(plan: Drawn, name: str, seed: int, number: int) -> dict[str, Any]:
    """Return the config of a run, by its number."""
    return config_of(f"{name} {seed} {number}", plan)


def first_config(plan: Drawn) -> dict[str, Any]:
    """Return some config of a plan."""
    return drawn(plan, "first", 0, 0)


def compiled(plan: Drawn) -> Any:
    """Compile the engine of a plan, so that no run waits for it; returns what it is made of."""
    experiment, spec = loaded(first_config(plan))
    run(experiment.cells()[0].config, spec, 1)
    return spec


def finds(plan: Drawn, count: int, name: str = "drawn", seed: int = 0) -> list[Find]:
    """Return what so many configs break on the engine of one plan.

    A plan's configs share an engine: one that requires another is a find, too.
    """
    shared = compiled(plan)
    trees = (drawn(plan, name, seed, number) for number in range(count))
    found = (Find(tree, judged(tree, shared).broken) for tree in trees)
    return [find for find in found if find.laws]


class Kept(NamedTuple):
    """The directory of finds, for the runs of one engine by one seed."""

    folder: Path
    engine: str
    seed: int

    @property
    def running(self) -> Path:
        """The file with the number of the run that is on its way."""
        return self.folder / f"{self.engine}_{self.seed}_running"

    def find(self, number: int) -> Path:
        """Return the file of a config that breaks laws."""
        return self.folder / f"{self.engine}_{self.seed}_{number}.yaml"

    def keep(self, number: int, find: Find) -> None:
        """Write a config with the laws that it breaks before it."""
        text = "".join(f"# {law}\n" for law in find.laws) + text_of(find.tree)
        self.find(number).write_text(text, encoding="utf-8")
        print(f"  {self.find(number)}: {'; '.join(find.laws)}", flush=True)

    def finished(self) -> list[dict[str, str]]:
        """Return the lines of finished runs of this engine."""
        return [row for row in lines(self.folder)
                if (row["engine"], row["seed"]) == (self.engine, str(self.seed))]  # fmt: skip

    def next(self) -> int:
        """Return the number of the run behind those that are finished."""
        return max((int(row["first"]) + int(row["runs"]) for row in self.finished()), default=0)

    def finish(self, first: int, end: int, seconds: float, laws: Counter[str]) -> None:
        """Note that the runs from `first` to before `end` are finished."""
        bad = sum(self.find(number).exists() for number in range(first, end))
        counts = [laws[law] for law in LAWS]
        row = [self.engine, self.seed, first, end - first, bad, f"{seconds:.2f}", *counts]
        with (self.folder / "finished.csv").open("a", encoding="utf-8") as file:
            file.write(",".join(map(str, row)) + "\n")


def lines(folder: Path) -> list[dict[str, str]]:
    """Return all lines of finished runs."""
    path = folder / "finished.csv"
    if not path.exists():
        return []
    heading, *rows = path.read_text(encoding="utf-8").splitlines()
    return [dict(zip(heading.split(","), row.split(","), strict=True)) for row in rows]


def fuzz(kept: Kept, plan: Drawn, count: int) -> None:
    """Run what is not finished of one engine; ends the process at a run that does not end."""
    first = kept.next()
    if first >= count:
        return
    shared = compiled(plan)
    begin, laws = time.process_time(), Counter[str]()
    parent = multiprocessing.parent_process()
    for number in range(first, count):
        if parent is not None and not parent.is_alive():
            return
        kept.running.write_text(str(number))
        tree = drawn(plan, kept.engine, kept.seed, number)
        result = judged(tree, shared, ENOUGH)
        laws.update(result.laws)
        if result.broken:
            kept.keep(number, Find(tree, result.broken))
        endless = any(law.startswith(ENDLESS) for law in result.broken)
        if endless or (number + 1) % CHUNK == 0 or number + 1 == count:
            kept.finish(first, number + 1, time.process_time() - begin, laws)
            first, begin, laws = number + 1, time.process_time(), Counter[str]()
        if endless:  # its kernel cannot be stopped
            os._exit(GOES_ON)
    kept.running.unlink()


def in_processes(kept: Kept, plan: Drawn, count: int) -> None:
    """Run what is not finished of one engine in a process, and in the next where that ends."""
    while kept.next() < count:
        context = multiprocessing.get_context("spawn")
        process = context.Process(target=fuzz, args=(kept, plan, count), daemon=True)
        process.start()
        process.join()
        if process.exitcode in (0, GOES_ON):
            continue
        number = int(kept.running.read_text())
        tree = drawn(plan, kept.engine, kept.seed, number)
        kept.keep(number, Find(tree, [f"ends: the process, with {process.exitcode}"]))
        kept.finish(kept.next(), number + 1, 0.0, Counter())


def summarised(folder: Path) -> int:
    """Say what is finished, and what it was judged by; returns how many runs broke a law."""
    rows = lines(folder)
    total = Counter({key: sum(int(row[key]) for row in rows) for key in ("runs", "finds", *LAWS)})
    engines = len({(row["engine"], row["seed"]) for row in rows})
    seconds = sum(float(row["seconds"]) for row in rows)
    print(
        f"{total['runs']} runs on {engines} engines, {total['finds']} broke a law; {seconds:.0f} s"
    )
    print("judged: " + ", ".join(f"{law} {total[law]}" for law in LAWS))
    return total["finds"]


def main(arguments: list[str]) -> int:
    """Fuzz as asked for, and say so."""
    parser = argparse.ArgumentParser(description="random configs against the engine")
    parser.add_argument("--runs", type=int, default=600, help="on all engines")
    parser.add_argument("--plans", type=int, default=2, help="drawn, beside three with all")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=1, help="processes at a time")
    parser.add_argument("--keep", type=Path, default=Path("fuzz_finds"), help="directory of finds")
    names = "of full, joined, accurate, plan_0, ..."
    parser.add_argument("--only", nargs="+", metavar="NAME", help=names)
    parser.add_argument("--report", action="store_true", help="say what is finished; run nothing")
    asked = parser.parse_args(arguments)
    asked.keep.mkdir(parents=True, exist_ok=True)
    if asked.report:
        return 1 if summarised(asked.keep) else 0
    if not (asked.keep / "finished.csv").exists():
        (asked.keep / "finished.csv").write_text(",".join(HEADING) + "\n")
    share = -(-asked.runs // (asked.plans + 3))
    drawn_ones = enumerate(drawn_plans(asked.plans, asked.seed))
    engines = {f"plan_{number}": (plan, share) for number, plan in drawn_ones}
    engines |= {"accurate": (ACCURATE, share)}
    engines |= {"joined": (JOINED, share), "full": (FULL, share)}  # dearest: last
    names = asked.only or list(engines)
    if not {*names} <= {*engines}:
        parser.error(f"--only: expected names out of {', '.join(engines)}")
    with ThreadPoolExecutor(asked.jobs) as pool:
        for done in [
            pool.submit(in_processes, Kept(asked.keep, name, asked.seed), *engines[name])
            for name in names
        ]:
            done.result()
    return 1 if summarised(asked.keep) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
