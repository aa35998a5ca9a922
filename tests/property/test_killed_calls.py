"""A kill before a call of the system leaves nothing half done, and what follows it is whole.

Before every 29th of them, every night before each, as `python -m tests.property.killed_calls` does.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest

from tests.property.failing_calls import preloaded
from tests.thorough import THOROUGH

EVERY = "1" if THOROUGH else "29"


@pytest.mark.skipif(sys.platform != "linux", reason="a library before the C library")
@pytest.mark.skipif(not (shutil.which("cc") or shutil.which("gcc")), reason="no compiler of C")
def test_before_whichever_call_it_is_killed_the_next_run_is_whole(tmp_path: Path) -> None:
    done = preloaded(tmp_path, "--every", EVERY, module="tests.property.killed_calls")
    assert done.returncode == 0, done.stdout
    assert done.stdout.endswith("0 with something wrong\n")
    killed = int(done.stdout.splitlines()[-2].split()[0])
    assert killed > 8
