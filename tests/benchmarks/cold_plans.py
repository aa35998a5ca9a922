"""What the plans of a folder's configs take to compile: alone, and after those before them.

    python -m tests.benchmarks.cold_plans configs/scenes [--json FILE]

Every config's first cell is compiled in a process of its own, twice: with an empty cache, and with
what the configs before it in the folder left in one. Printed is the time of the processor [s], how
many of its parts were compiled then and how many were there. `--check` holds the two bounds.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from lavendersim.runner import find_configs

ALONE = 12.0  # [s] the most that a plan may take with an empty cache
SHARED = 5.0  # [s] and where most of its parts were compiled before
COMPILE = """
import json, sys
from time import process_time
from lavendersim.engine.kernel_parts import STORE
from lavendersim.experiment import load_experiment
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of_cell
cell = load_experiment(sys.argv[1]).cells()[0]
spec = plan_of_cell(cell).spec
engine = build(cell.config, spec).engine(spec)
begin, keep, made = process_time(), STORE.keep, []
STORE.keep = lambda part: (made.append(1), keep(part))
engine.advance(0)
print(json.dumps({"plan": spec.digest(), "seconds": process_time() - begin, "made": len(made),
                  "found": len(STORE._parts) - len(made), "loaded": engine._kernel._cache.hits}))
"""


def compiled(config: Path, kernels: Path) -> dict[str, Any]:
    """Compile the plan of a config's first cell in a new process."""
    ended = subprocess.run(
        [sys.executable, "-c", COMPILE, str(config)],
        env=os.environ | {"LAVENDER_CACHE_DIR": str(kernels)},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    found: dict[str, Any] = json.loads(ended.stdout.splitlines()[-1])
    return found


def main() -> int:
    """Print the table; with --check say which plans take longer than they may."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("configs", nargs="*", type=Path, default=[Path("configs/scenes")])
    parser.add_argument("--json", type=Path)
    parser.add_argument("--check", action="store_true")
    asked = parser.parse_args()
    rows, seen = [], set()
    with tempfile.TemporaryDirectory() as folder:
        together = Path(folder) / "together"
        for number, path in enumerate(find_configs(asked.configs)):
            alone = compiled(path, Path(folder) / str(number))
            if alone["plan"] in seen:
                continue  # it is on disk by now
            seen.add(alone["plan"])
            after = compiled(path, together)
            rows.append({"config": str(path), "alone": alone, "after": after})
            print(
                f"{path!s:50} {alone['seconds']:6.1f} {after['seconds']:6.1f}  "
                f"{after['made']:4d} compiled {after['found']:4d} there",
                flush=True,
            )
    total = [sum(row[way]["seconds"] for row in rows) for way in ("alone", "after")]
    print(f"{len(rows)} plans{'':42} {total[0]:6.1f} {total[1]:6.1f}")
    if asked.json:
        asked.json.write_text(json.dumps(rows, indent=1))
    missed = [row["config"] for row in rows if row["alone"]["seconds"] > ALONE]
    missed += [
        row["config"]
        for row in rows
        if row["after"]["found"] > row["after"]["made"] and row["after"]["seconds"] > SHARED
    ]
    if asked.check:
        print("\n".join(f"longer than it may: {name}" for name in missed) or "every bound is held")
    return int(asked.check and bool(missed))


if __name__ == "__main__":
    sys.exit(main())
