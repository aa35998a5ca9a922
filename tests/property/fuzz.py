"""Random configs on the fullest engine and on drawn ones; says what broke, and keeps it.

    python tests/property/fuzz.py --runs 10000 --plans 20 --keep finds

Every run is one of `fuzz_laws.broken`: on the plan with every effect and pair of shapes for as many
`--runs`, then on so many drawn `--plans` for a share of them each; `--only full plan_3` picks some,
for a process each. Runs are drawn in chunks, each from a seed of its own. The directory `--keep`
holds a line per finished chunk, in `finished.csv`: started again, the program goes on behind them.
It also holds each config that breaks a law, as a config that replays it, and the config that runs,
as `<chunk>_running.yaml`, so that it is known where the process itself ends. Exit 1 where anything
broke.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple
from unittest.mock import patch

from fuzz_laws import broken, loaded, run, text_of
from fuzz_scenes import FULL, Drawn, configs, plans
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import seed as seeded
from hypothesis.internal.conjecture import providers

CHUNK = 500  # runs from one seed: what an interruption loses at most
HEADING = "engine,seed,chunk,runs,finds,seconds\n"


class Find(NamedTuple):
    """A config that breaks laws, and which."""

    tree: dict[str, Any]
    laws: list[str]


@contextmanager
def without_constants_of_modules() -> Iterator[None]:
    """Draw no number because a module has it: an edit elsewhere would draw all configs anew."""
    cache = getattr(providers, "CONSTANTS_CACHE", None)  # neither is there in releases before
    if cache is None or not hasattr(providers, "_get_local_constants"):
        yield
        return
    cache.cache.clear()
    with patch.object(providers, "_get_local_constants", providers.Constants):
        yield
    cache.cache.clear()


def drawn(strategy: Any, count: int, take: Callable[[Any], None], seed: int | str) -> None:
    """Draw so many values, the same on every machine and day, and hand each on."""

    @seeded(seed)
    @settings(
        max_examples=count,
        deadline=None,
        database=None,
        phases=[Phase.generate],  # reported as drawn: to shrink is to run hundreds
        suppress_health_check=list(HealthCheck),
    )
    @given(strategy)
    def each(value: Any) -> None:
        take(value)

    with without_constants_of_modules():
        each()


def drawn_plans(count: int, seed: int = 0) -> list[Drawn]:
    """Return so many plans; hypothesis begins with its simplest, which is passed over."""
    found: list[Drawn] = []
    drawn(plans(), 2 * count + 4, found.append, seed)
    different = {repr(plan): plan for plan in found[2:]}
    return list(different.values())[:count]


def first_config(plan: Drawn) -> dict[str, Any]:
    """Return some config of a plan."""
    found: list[dict[str, Any]] = []
    drawn(configs(plan), 1, found.append, 0)
    return found[0]


def compiled(plan: Drawn) -> None:
    """Compile the engine of a plan, so that no run waits for it."""
    experiment, spec = loaded(first_config(plan))
    run(experiment.cells()[0].config, spec, 1)


def finds(
    plan: Drawn, count: int, keep: Path | None = None, seed: int | str = 0
) -> tuple[int, list[Find]]:
    """Run so many configs on the engine of one plan; returns their number, and what broke.

    A plan's configs share an engine: one that requires another is a find, too. keep: the beginning
    of the names of finds, and of the file for the config that runs.
    """
    compiled(plan)
    shared = loaded(first_config(plan))[1]
    running = None if keep is None else keep.with_name(f"{keep.name}_running.yaml")
    done, found = 0, []

    def take(tree: dict[str, Any]) -> None:
        nonlocal done
        if running is not None:
            running.write_text(text_of(tree))
        laws = broken(tree, shared)
        done += 1
        if laws:
            found.append(Find(tree, laws))
            if keep is not None:
                path = keep.with_name(f"{keep.name}_{done}.yaml")
                path.write_text("".join(f"# {law}\n" for law in laws) + text_of(tree))
                print(f"  {path}: {'; '.join(laws)}", flush=True)

    drawn(configs(plan), count, take, seed)
    if running is not None:
        running.unlink()
    return done, found


def finished(keep: Path) -> dict[tuple[str, int, int], tuple[int, int]]:
    """Return the runs and finds of every chunk that a directory tells of."""
    path = keep / "finished.csv"
    if not path.exists():
        path.write_text(HEADING)
    rows = (line.split(",") for line in path.read_text().splitlines()[1:])
    return {(name, int(seed), int(chunk)): (int(runs), int(found))
            for name, seed, chunk, runs, found, _ in rows}  # fmt: skip


def fuzz(name: str, plan: Drawn, count: int, seed: int, keep: Path) -> int:
    """Run what is not finished of one engine; returns how many of all its runs broke a law.

    Tells how far it is after every chunk.
    """
    laws = ", ".join(f"{value}" for value in plan.numerics.values())
    print(f"{name} ({laws}; {len(plan.effects)} effects; {'/'.join(plan.shapes)})", flush=True)
    runs, bad = 0, 0
    for chunk, first in enumerate(range(0, count, CHUNK)):
        begin, due = time.perf_counter(), min(CHUNK, count - first)
        done, broke = finished(keep).get((name, seed, chunk), (0, 0))
        if done < due:
            key = f"{name}_{seed}_{chunk}"
            done, found = finds(plan, due, keep / key, key)
            broke = len(found)
            with (keep / "finished.csv").open("a") as file:
                seconds = time.perf_counter() - begin
                file.write(f"{name},{seed},{chunk},{done},{broke},{seconds:.0f}\n")
        runs, bad = runs + done, bad + broke
        print(f"  {runs} of {count} runs, {bad} broke a law", flush=True)
    return bad


def main(arguments: list[str]) -> int:
    """Fuzz as asked for, and say so."""
    parser = argparse.ArgumentParser(description="random configs against the engine")
    parser.add_argument("--runs", type=int, default=300, help="on the full plan")
    parser.add_argument("--plans", type=int, default=2, help="drawn, with a tenth of the runs each")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path, default=Path("fuzz_finds"), help="directory of finds")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="of full, plan_0, plan_1, ...")
    asked = parser.parse_args(arguments)
    asked.keep.mkdir(parents=True, exist_ok=True)
    engines = {"full": (FULL, asked.runs)}
    for number, plan in enumerate(drawn_plans(asked.plans, asked.seed)):
        engines[f"plan_{number}"] = (plan, max(asked.runs // 10, 1))
    names = asked.only or list(engines)
    if not {*names} <= {*engines}:
        parser.error(f"--only: expected names out of {', '.join(engines)}")
    broke = sum(fuzz(name, *engines[name], asked.seed, asked.keep) for name in names)
    return 1 if broke else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
