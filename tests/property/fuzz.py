"""Random configs on the fullest engine and on drawn ones; says what broke, and keeps it.

    python tests/property/fuzz.py --runs 10000 --plans 20 --keep finds

Every run is one of `fuzz_laws.broken`: on the plan with every effect and pair of shapes for as many
`--runs`, then on so many drawn `--plans` for a share of them each. Each config that breaks a law is
written to the directory `--keep`, as a config that replays it. The config that runs stands there as
`running.yaml`, so that it is known where the process itself ends. Exit 1 where anything
broke that is not known (`fuzz_laws.KNOWN`).
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from fuzz_laws import KNOWN, broken, loaded, run, text_of, unknown
from fuzz_scenes import FULL, Drawn, configs, plans
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import seed as seeded

PROGRESS = 500  # runs between two lines that tell how far it is


class Find(NamedTuple):
    """A config that breaks laws, and which."""

    tree: dict[str, Any]
    laws: list[str]


def drawn(strategy: Any, count: int, take: Callable[[Any], None], seed: int) -> None:
    """Draw so many values, the same on every machine and day, and hand each on."""

    @seeded(seed)
    @settings(
        max_examples=count,
        deadline=None,
        database=None,
        phases=[Phase.generate],  # what breaks is told as drawn: to shrink it is to run hundreds
        suppress_health_check=list(HealthCheck),
    )
    @given(strategy)
    def each(value: Any) -> None:
        take(value)

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
    run(experiment.cells()[0].resolved, spec, 1)


def finds(
    plan: Drawn, count: int, keep: Path | None = None, seed: int = 0
) -> tuple[int, list[Find]]:
    """Run so many configs on the engine of one plan; returns their number, and what broke.

    A plan's configs share an engine: one that calls for another is a find, too. keep: a file for
    the config that runs, and the beginning of the names of finds.
    """
    compiled(plan)
    shared = loaded(first_config(plan))[1]
    done, found = 0, []

    def take(tree: dict[str, Any]) -> None:
        nonlocal done
        if keep is not None:
            keep.with_name("running.yaml").write_text(text_of(tree))
        laws = broken(tree, shared)
        done += 1
        if laws:
            found.append(Find(tree, laws))
            if keep is not None:
                path = keep.with_name(f"{keep.name}_{done}.yaml")
                path.write_text("".join(f"# {law}\n" for law in laws) + text_of(tree))
                print(f"  {path}: {'; '.join(laws)}", flush=True)
        if keep is not None and done % PROGRESS == 0:
            print(f"  {done} of {count} runs", flush=True)

    drawn(configs(plan), count, take, seed)
    return done, found


def main(arguments: list[str]) -> int:
    """Fuzz as asked for, and say so."""
    parser = argparse.ArgumentParser(description="random configs against the engine")
    parser.add_argument("--runs", type=int, default=300, help="on the full plan")
    parser.add_argument("--plans", type=int, default=2, help="drawn, with a tenth of the runs each")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path, default=Path("fuzz_finds"), help="directory of finds")
    asked = parser.parse_args(arguments)
    asked.keep.mkdir(parents=True, exist_ok=True)
    engines = {"full": (FULL, asked.runs)}
    for number, plan in enumerate(drawn_plans(asked.plans, asked.seed)):
        engines[f"plan_{number}"] = (plan, max(asked.runs // 10, 1))
    broke = 0
    for name, (plan, count) in engines.items():
        begin = time.perf_counter()
        done, found = finds(plan, count, asked.keep / f"{name}_{asked.seed}", asked.seed)
        known = [find for find in found if not unknown(find.laws)]
        broke += len(found) - len(known)
        took = f"{time.perf_counter() - begin:.0f} s"
        laws = ", ".join(f"{value}" for value in plan.numerics.values())
        print(f"{name} ({laws}; {len(plan.effects)} effects; {'/'.join(plan.shapes)}): "
              f"{done - len(found)} of {done} runs broke nothing, {took}")  # fmt: skip
        if known:
            print(f"  {len(known)} of the others broke no more than is known ({', '.join(KNOWN)})")
        sys.stdout.flush()
    (asked.keep / "running.yaml").unlink(missing_ok=True)
    return 1 if broke else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
