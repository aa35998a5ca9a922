"""Mutants are what they are called, and the tests of what was changed see them.

`python -m tests.property.mutants` breaks as many lines of the engine as are asked for.
"""

from __future__ import annotations

import importlib.util
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.property.engine_mutants import ENGINE, Mutant, applied, groups, mutants_of
from tests.property.explained_mutants import EXPLAINED, change_of
from tests.property.forked_tests import forks
from tests.property.interpreter_mode import broken

ROOT = Path(__file__).parents[2]
KERNEL = """\
def make(spec):
    def push(body, rows, count):
        for k in range(count):
            body.vx += 0.5 * rows[1] - body.vy
            if body.vx > 0.0:
                body.vx = -body.vy

    return push
"""


def test_each_kind_of_mutant_changes_one_piece_of_a_kernel() -> None:
    found = {
        (mutant.kind, applied(KERNEL, mutant).splitlines()[mutant.line - 1].strip())
        for mutant in mutants_of("push.py", KERNEL, {"vx", "vy"})
    }
    assert {
        ("count", "for k in range((count) - 1):"),
        ("sign", "body.vx += 0.5 * rows[1] + body.vy"),
        ("sign", "body.vx -= 0.5 * rows[1] - body.vy"),
        ("factor", "body.vx += 1.0 * rows[1] - body.vy"),
        ("factor", "body.vx += 0.5 / rows[1] - body.vy"),
        ("index", "body.vx += 0.5 * rows[0] - body.vy"),
        ("index", "body.vy += 0.5 * rows[1] - body.vy"),
        ("comparison", "if body.vx <= 0.0:"),
        ("sign", "body.vx = (body.vy)"),
    } <= found


def test_every_group_of_files_has_mutants_enough_to_draw_from() -> None:
    assert all(len(mutants) > 300 for mutants in groups().values())


def test_each_mutant_that_is_explained_is_one_that_can_be_drawn() -> None:
    """Its line still stands in the engine, once, and says something else when it is broken."""
    sources: dict[str, list[Mutant]] = {}
    for mutant in (one for mutants in groups().values() for one in mutants):
        sources.setdefault(mutant.file, []).append(mutant)
    for file, entries in EXPLAINED.items():
        text = (ROOT / ENGINE / file).read_text()
        changes = [change_of(mutant, text) for mutant in sources[file]]
        for whole, changed, why in entries:
            assert changes.count((whole, changed)) == 1, (file, whole, changed)
            assert len(why) > 10


def test_what_a_broken_module_made_before_and_makes_afterwards_is_broken(tmp_path: Path) -> None:
    path = tmp_path / "broken_module.py"
    path.write_text("def make(a):\n    def add(x):\n        return a + x\n\n    return add\n")
    spec = importlib.util.spec_from_file_location("broken_module", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    before = module.make(5)
    assert before(3) == 8
    assert broken(path, path.read_text().replace("a + x", "a - x")) == 2  # the maker, and its own
    assert (before(3), module.make(7)(3)) == (2, 4)


def test_a_fork_says_how_it_ended_and_does_not_outlive_its_limits() -> None:
    def works() -> Iterator[Callable[[Path], Any]]:
        yield lambda said: said.write_text("done")
        yield lambda said: os.kill(os.getpid(), signal.SIGTERM)
        yield lambda said: time.sleep(60)

    found = {one.number: one for one in forks(works(), 3, (5.0, 1.0))}
    assert [found[k].status for k in range(3)] == [0, -signal.SIGTERM, -signal.SIGKILL]
    assert found[0].said == "done"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks")
def test_mutants_of_the_cone_are_seen_by_its_tests() -> None:
    asked = ("--count", "2", "--only", "cone.py", "--tests", "tests/unit/engine/test_cone.py")
    done = subprocess.run(
        [sys.executable, "-m", "tests.property.mutants", *asked],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "mutants are seen" in done.stdout
    assert int(done.stdout.splitlines()[-1].split()[0]) == 2, done.stdout
