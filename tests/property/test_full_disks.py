"""A disk that is full ends a run with a sentence; on a larger one it goes on to the same bytes."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.thorough import THOROUGH

COUNT = 24 if THOROUGH else 3
PLACE = ("unshare", "-rm")  # where a disk may be mounted without rights


def may_mount() -> bool:
    """Whether this system lets one mount a disk of one's own."""
    if shutil.which(PLACE[0]) is None:
        return False
    mount = "mount -t tmpfs tmpfs /mnt"
    done = subprocess.run([*PLACE, "sh", "-c", mount], capture_output=True, check=False)
    return done.returncode == 0


@pytest.mark.skipif(not may_mount(), reason="no disk of one's own can be mounted")
def test_wherever_the_disk_is_full_the_run_goes_on_when_it_is_larger() -> None:
    module = ("-m", "tests.property.full_disks")
    done = subprocess.run(
        [*PLACE, sys.executable, *module, "--count", str(COUNT), "--seed", "3"],
        cwd=Path(__file__).parents[2],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    full = int(done.stdout.splitlines()[-2].split()[0])
    assert full >= COUNT // 2
