"""What every shipped config does, pinned: last state hashes, verdicts, refusals of bad configs.

    python -m tests.pinned.behaviour --write before.json            # on the commit to hold on to
    python -m tests.pinned.behaviour --compare before.json          # on the commit to be compared
    python -m tests.pinned.behaviour --compare before.json configs/chapter   # only a part

A change of words that is meant goes through `renames.json`: a list of [pattern, replacement] pairs
of regular expressions, applied to the texts of both sides before they are compared; its last entry
leaves out the keys that effects have brought since. Hashes and verdicts are compared as they stand.
Slow configs are run at their reduced length, overheads are not
taken. Hashes are those of one machine and one set of library versions, so the file that is written
belongs beside neither the sources nor another machine's.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment
from lavendersim.runner import run
from lavendersim.trace import open_trace

ROOT = Path(__file__).parents[2]
CONFIGS = ROOT / "configs"
BAD = ROOT / "tests/configs/bad"
RENAMES = Path(__file__).with_name("renames.json")


def outcome(path: Path, jobs: int) -> dict[str, Any]:
    """Return how each cell of a config ended, with its last state hash, and every verdict."""
    experiment = load_experiment(path, True)
    with tempfile.TemporaryDirectory() as root:
        finished = run(experiment, root, jobs, overheads=False)
        cells = {}
        for cell in finished.run.cells:
            trace = open_trace(cell.path, allow_incomplete=True)
            step = trace.step
            cells[str(cell.index)] = {
                "label": cell.label,
                "status": cell.status,
                "steps": int(step["step"][-1]),
                "state_hash": f"{int(step['state_hash'][-1]):016x}",
            }
        verdicts = [f"{one.name}: {'pass' if one.passed else 'fail'}" for one in finished.verdicts]
    return {"cells": cells, "verdicts": verdicts}


def refusal(path: Path) -> list[str]:
    """Return the sentences that a bad config is refused with."""
    try:
        load_experiment(path)
    except ConfigError as error:
        return [str(defect._replace(file=path.name)) for defect in error.defects]
    return []


def found(paths: list[Path], jobs: int, bad: bool) -> dict[str, Any]:
    """Return the behaviour of all configs below `paths`, by their place below `configs`."""
    table: dict[str, Any] = {"configs": {}, "refusals": {}}
    for path in (file for top in paths for file in sorted(top.rglob("*.yaml")) or [top]):
        start = time.perf_counter()
        name = path.resolve().relative_to(CONFIGS).as_posix()
        table["configs"][name] = outcome(path, jobs)
        print(f"{name}: {time.perf_counter() - start:.1f} s", file=sys.stderr, flush=True)
    if bad:
        table["refusals"] = {path.stem: refusal(path) for path in sorted(BAD.rglob("*.yaml"))}
    return table


def renamed(value: Any, renames: list[tuple[str, str]]) -> Any:
    """Return the same with every text brought to the words of today."""
    if isinstance(value, dict):
        return {renamed(key, renames): renamed(one, renames) for key, one in value.items()}
    if isinstance(value, list):
        return [renamed(one, renames) for one in value]
    if isinstance(value, str):
        for pattern, replacement in renames:
            value = re.sub(pattern, replacement, value)
    return value


def differences(before: dict[str, Any], after: dict[str, Any]) -> list[str]:
    """Return one line for every entry of `after` that is not what it was before."""
    lines = []
    for section in after:
        for name, value in after[section].items():
            if name not in before[section]:
                lines.append(f"{section}: {name}: was not there before")
            elif value != before[section][name]:
                lines += [f"{section}: {name}:", *_unequal(before[section][name], value)]
    return lines


def _unequal(before: Any, after: Any) -> list[str]:
    if isinstance(before, dict) and isinstance(after, dict):
        keys = sorted(before.keys() | after.keys())
        return [
            line
            for key in keys
            if before.get(key) != after.get(key)
            for line in (f"  {key}:", *_unequal(before.get(key), after.get(key)))
        ]
    return [f"  - {json.dumps(before)}", f"  + {json.dumps(after)}"]


def main() -> int:
    """Write what is found, or hold it against what was found before."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("paths", nargs="*", type=Path, default=[CONFIGS])
    parser.add_argument("--write", type=Path)
    parser.add_argument("--compare", type=Path)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--bad-only", action="store_true", help="only the refusals")
    given = parser.parse_args()
    paths = [] if given.bad_only else given.paths
    after = found(paths, given.jobs, bad=given.bad_only or CONFIGS in given.paths)
    if given.write:
        given.write.write_text(json.dumps(after, indent=1) + "\n")
    if not given.compare:
        return 0
    renames = json.loads(RENAMES.read_text()) if RENAMES.exists() else []
    before = renamed(json.loads(given.compare.read_text()), renames)
    lines = differences(before, renamed(after, renames))
    print("\n".join(lines) or f"no difference in {sum(map(len, after.values()))} entries")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
