"""A forked process is what a started one is: streams, exit code, directory, environment, memory."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.forked_python import python

SEEN = """
import json, os, sys
print(json.dumps([sys.argv, sys.path[0], os.getcwd(), os.environ.get("NO_COLOR"), __name__]))
print("to stderr", file=sys.stderr)
"""


def started(*arguments: object, where: Path, **_: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, *map(str, arguments)],
        cwd=where, capture_output=True, text=True, check=False,
    )  # fmt: skip


@pytest.mark.parametrize("form", ["module", "code", "file"])
def test_it_sees_what_a_started_one_sees(
    form: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "seen_of_a_process.py"
    file.write_text(SEEN)
    words = {"module": ("-m", file.stem), "code": ("-c", SEEN), "file": (file,)}[form]
    monkeypatch.setenv("NO_COLOR", "1")
    forked = python(*words, "a", "b c", where=tmp_path)
    expected = started(*words, "a", "b c", where=tmp_path)
    assert json.loads(forked.stdout)[1:] == json.loads(expected.stdout)[1:]
    assert json.loads(forked.stdout)[0][1:] == ["a", "b c"]
    assert forked.stderr == "to stderr\n"


@pytest.mark.parametrize(
    "code",
    [
        "pass",
        "raise SystemExit",
        "raise SystemExit(3)",
        "raise SystemExit('a sentence')",
        "1 / 0",
        "import os; os.kill(os.getpid(), 9)",
        "import atexit; atexit.register(print, 'at the end'); print('before')",
        "import threading, time\nthreading.Timer(0.1, print, ['from a thread']).start()",
    ],
)
def test_it_ends_as_a_started_one_ends(code: str, tmp_path: Path) -> None:
    forked, expected = python("-c", code, where=tmp_path), started("-c", code, where=tmp_path)
    assert (forked.returncode, forked.stdout) == (expected.returncode, expected.stdout)
    assert forked.stderr.splitlines()[-1:] == expected.stderr.splitlines()[-1:]


def test_nothing_is_left_in_the_next_process(tmp_path: Path) -> None:
    change = "import lavendersim, os; lavendersim.changed = True; os.environ['CHANGED'] = '1'"
    look = "import lavendersim, os; print(hasattr(lavendersim, 'changed'), 'CHANGED' in os.environ)"
    assert python("-c", change, where=tmp_path).returncode == 0
    assert python("-c", look, where=tmp_path).stdout == "False False\n"


def test_the_command_line_is_not_imported_before_it_is_run(tmp_path: Path) -> None:
    look = "import sys; print('numba' in sys.modules, 'lavender_cli.main' in sys.modules)"
    assert python("-c", look, where=tmp_path).stdout == "True False\n"


def test_a_variable_that_imports_may_read_starts_an_interpreter(tmp_path: Path) -> None:
    look = "import sys; print('numba' in sys.modules)"
    kept = python("-c", look, where=tmp_path, LAVENDER_CACHE_DIR=str(tmp_path / "kernels"))
    assert kept.stdout == "True\n"
    assert python("-c", look, where=tmp_path, NUMBA_OPT="1").stdout == "False\n"


def test_a_variable_that_is_gone_is_gone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    look = "import os; print('NO_COLOR' in os.environ)"
    monkeypatch.setenv("NO_COLOR", "1")
    assert python("-c", look, where=tmp_path).stdout == "True\n"
    monkeypatch.delenv("NO_COLOR")
    assert python("-c", look, where=tmp_path).stdout == "False\n"
