"""Edits of the engine's sources, and whether anything stale is run after one.

A number in a random kernel is changed, in a copy of the package, and the same scene runs twice:
with the parts and kernels that the engine had left before, and with none at all. The suite does it
for a few; as a program it does it for as many as are asked for:

    python tests/property/engine_edits.py --edits 100 --seed 7
"""

from __future__ import annotations

import argparse
import ast
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

from lavendersim.engine.step import kernels_of
from lavendersim.experiment import load_experiment
from lavendersim.scene.plan import plan_of_cell

ROOT = Path(__file__).parents[2]
SCENE = ROOT / "configs/chapter/warm_start.yaml"


# Prints what the first cell's steps come to, and the machine code that made them.
RUN = """
import hashlib, json, sys
sys.path.insert(0, sys.argv[2])
from machine_code import text_of
import lavendersim
from lavendersim.experiment import load_experiment
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of_cell
cell = load_experiment(sys.argv[1]).cells()[0]
engine = build(cell.config, spec := plan_of_cell(cell).spec).engine(spec)
status = [engine.advance(0), engine.advance(100)]
rows = engine.take_rows()
said = {"package": lavendersim.__file__, "status": status, "code": text_of(engine)}
said["rows"] = [hashlib.sha256(part.tobytes()).hexdigest() for part in rows]
print(json.dumps(said))
print(json.dumps({"hits": engine._kernel._cache.hits}))
"""


class Edit(NamedTuple):
    """A number in a kernel, and what takes its place."""

    path: Path
    line: int
    begin: int  # columns
    end: int
    new: str


def _numbers(tree: ast.Module) -> list[ast.Constant]:
    """Return the floats in functions that a maker returns: in kernels."""
    return [
        constant
        for maker in tree.body
        if isinstance(maker, ast.FunctionDef)
        for function in ast.walk(maker)
        if isinstance(function, ast.FunctionDef) and function is not maker
        for constant in ast.walk(function)
        if isinstance(constant, ast.Constant) and isinstance(constant.value, float)
    ]


def edits(files: list[Path], count: int, seed: int) -> list[Edit]:
    """Draw edits; the floats of kernels, since another integer may reach beyond an array."""
    found = []
    for path in files:
        for node in _numbers(ast.parse(path.read_text())):
            end = node.end_col_offset or node.col_offset
            new = repr(1.25 * node.value + 0.125)
            found.append(Edit(path, node.lineno, node.col_offset, end, new))
    return random.Random(seed).sample(found, count)


def apply(edits: list[Edit]) -> None:
    """Write the edited files; of edits in one line the last is made first, so that columns hold."""
    for edit in sorted(edits, key=lambda edit: edit.begin, reverse=True):
        lines = edit.path.read_text().splitlines(keepends=True)
        line = lines[edit.line - 1]
        lines[edit.line - 1] = line[: edit.begin] + edit.new + line[edit.end :]
        edit.path.write_text("".join(lines))


def run(package: Path, kernels: Path) -> tuple[Any, Any]:
    """Run the scene by a copy of the package; return what it came to, and how it was compiled."""
    environment = os.environ | {"PYTHONPATH": str(package), "LAVENDER_CACHE_DIR": str(kernels)}
    ended = subprocess.run(
        [sys.executable, "-P", "-c", RUN, str(SCENE), str(ROOT / "tests/oracle")],
        env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ended.returncode == 0, ended.stderr
    said, compiled = map(json.loads, ended.stdout.splitlines())
    assert Path(said["package"]).is_relative_to(package)
    return said, compiled


def files_of_the_scene(package: Path) -> list[Path]:
    """Return the sources that have kernels of the scene."""
    modules = kernels_of(plan_of_cell(load_experiment(SCENE).cells()[0]).spec)
    engine = package / "lavendersim/engine"
    found = [engine / (module.replace(".", "/") + ".py") for module in modules]
    return [path for path in found if path.is_file()]


def prepared(folder: Path) -> tuple[Path, Path]:
    """Return a copy of the package, and a cache that has all it compiled for the scene."""
    shutil.copytree(
        ROOT / "lavendersim", folder / "lavendersim", ignore=shutil.ignore_patterns("__pycache__")
    )
    run(folder, folder / "kept")
    return folder, folder / "kept"


def differs(package: Path, kept: Path, edits: list[Edit], place: Path) -> str:
    """Make edits, compare, and take them back; return what differs, or nothing."""
    before = {edit.path: edit.path.read_text() for edit in edits}
    used = place / "used"
    shutil.copytree(kept, used)
    apply(edits)
    try:
        after, _ = run(package, used)
        fresh, _ = run(package, place / "fresh")
    finally:
        for path, text in before.items():
            path.write_text(text)
    where = ", ".join(f"{edit.path.name}:{edit.line}: {edit.new}" for edit in edits)
    return "" if after == fresh else f"{where}: {after} is not {fresh}"


def main() -> int:
    """Try many edits; say which of them ran anything stale."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--edits", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        copy, kept = prepared(Path(folder))
        failed = 0
        drawn = edits(files_of_the_scene(copy), asked.edits, asked.seed)
        for number, edit in enumerate(drawn):
            wrong = differs(copy, kept, [edit], Path(folder) / str(number))
            shutil.rmtree(Path(folder) / str(number))
            failed += bool(wrong)
            print(wrong or f"{edit.path.name}:{edit.line}: as fresh", flush=True)
    print(f"{failed} of {asked.edits} ran something stale")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
