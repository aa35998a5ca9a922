"""Processes that want the same kernel compile it once; a lock ends with its process."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from lavendersim.engine.compile_lock import NAME, CompileLock

pytestmark = pytest.mark.skipif(os.name != "posix", reason="record locks of POSIX")

KEY, OTHER = "0123456789abcdef" * 2, "f123456789abcdef" * 2
# Compiles a small kernel or loads it, and prints how often it did which. Says when it waits.
COMPILE = """
import json
from lavendersim.engine import compile_lock
from lavendersim.engine.compile import inner
from lavendersim.engine.kernel_cache import KernelCache
from lavendersim.engine.spec import Spec

class Clock:
    monotonic = compile_lock.time.monotonic
    sleeping = compile_lock.time.sleep

    def sleep(seconds):
        print("waiting", flush=True)
        Clock.sleeping(seconds)

compile_lock.time = Clock

def twice(x):
    return 2 * x

kernel = inner(twice)
cache = kernel._cache = KernelCache(Spec(), kernel)
print(cache.key((__import__("numba").int64,)), flush=True)
input()
assert kernel(21) == 42
print(json.dumps([cache.hits, cache.misses]))
"""
# Holds the lock of a key until its input ends.
HOLD = """
import sys
from pathlib import Path
from lavendersim.engine.compile_lock import CompileLock
lock = CompileLock()
print(lock.take(Path(sys.argv[1]), sys.argv[2]), flush=True)
sys.stdin.read()
"""


def start(code: str, *arguments: object, folder: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", code, *map(str, arguments)],
        env=os.environ | {"LAVENDER_CACHE_DIR": str(folder)},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )


def line_of(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    return process.stdout.readline().strip()


def counts(process: subprocess.Popen[str], words: str = "\n") -> tuple[int, int]:
    """Let a process compile; return how often it loaded and compiled."""
    hits, misses = json.loads(process.communicate(words)[0].splitlines()[-1])
    return hits, misses


def test_who_waits_for_a_kernel_loads_what_was_made(tmp_path: Path) -> None:
    maker, waiting = (start(COMPILE, folder=tmp_path) for _ in range(2))
    key, same = line_of(maker), line_of(waiting)
    assert key == same
    lock = CompileLock()
    assert lock.take(tmp_path, key)
    assert waiting.stdin is not None
    waiting.stdin.write("\n")
    waiting.stdin.flush()
    assert line_of(waiting) == "waiting"
    lock.release()  # the maker may come second: then it is the one that loads
    found = [counts(maker), counts(waiting, "")]
    assert sorted(found) == [(0, 1), (1, 0)]


def test_processes_that_begin_together_compile_once(tmp_path: Path) -> None:
    processes = [start(COMPILE, folder=tmp_path) for _ in range(4)]
    assert len({line_of(process) for process in processes}) == 1
    for process in processes:
        assert process.stdin is not None
        process.stdin.write("\n")
        process.stdin.flush()
    found = [counts(process, "") for process in processes]
    assert sum(misses for _, misses in found) == 1
    assert sum(hits for hits, _ in found) == 3


def test_a_killed_process_lets_its_lock_go(tmp_path: Path) -> None:
    holder, lock = start(HOLD, tmp_path, KEY, folder=tmp_path), CompileLock()
    assert line_of(holder) == "True"
    assert not lock.take(tmp_path, KEY, longest=0.0)
    assert lock.take(tmp_path, OTHER, longest=0.0), "another kernel has a lock of its own"
    holder.kill()
    holder.wait()
    assert lock.take(tmp_path, KEY, longest=0.0)


def test_who_has_waited_for_longest_compiles_by_himself(tmp_path: Path) -> None:
    holder, lock = start(HOLD, tmp_path, KEY, folder=tmp_path), CompileLock()
    assert line_of(holder) == "True"
    begin = time.monotonic()
    assert not lock.take(tmp_path, KEY, longest=0.2)
    assert time.monotonic() - begin >= 0.2
    holder.communicate()


@pytest.mark.parametrize("what", ["folder", "link", "nothing above it"])
def test_where_there_can_be_no_lock_nobody_waits(tmp_path: Path, what: str) -> None:
    kernels, elsewhere = tmp_path / "kernels", tmp_path / "elsewhere"
    if what != "nothing above it":
        kernels.mkdir()
    if what == "folder":
        (kernels / NAME).mkdir()
    elif what == "link":
        (kernels / NAME).symlink_to(elsewhere)
    assert not CompileLock().take(kernels, KEY)
    assert not elsewhere.exists()
