"""Mutants are what they are called, and the tests of what was changed see them.

`python -m tests.property.mutants` breaks as many lines of the engine as are asked for.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.property.engine_mutants import applied, groups, mutants_of

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
