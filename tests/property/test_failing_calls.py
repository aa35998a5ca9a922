"""A call of the system that fails ends a run with a sentence, and leaves nothing that is half done.

Every 13th of them by each error, every night all, as `python -m tests.property.failing_calls`.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest

from tests.property.failing_calls import preloaded
from tests.thorough import THOROUGH

EVERY = "1" if THOROUGH else "13"


@pytest.mark.skipif(sys.platform != "linux", reason="a library before the C library")
@pytest.mark.skipif(not (shutil.which("cc") or shutil.which("gcc")), reason="no compiler of C")
def test_whichever_call_fails_it_is_said_and_nothing_is_half_done(tmp_path: Path) -> None:
    done = preloaded(tmp_path, "--every", EVERY)
    assert done.returncode == 0, done.stdout
    assert done.stdout.endswith("0 with something wrong\n")
    failed = int(done.stdout.splitlines()[-2].split()[0])
    assert failed > 20  # every 13th of some 390
