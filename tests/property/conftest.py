"""The oracles' folder, for the laws of whole runs; optimised kernels for those of many steps."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "oracle"))


@pytest.fixture(scope="module")
def optimised() -> Iterator[None]:
    """Compile as users do, here and in processes that are started: what makes millions of steps."""
    from numba import config  # late: most tests here ask for it themselves

    before = os.environ["NUMBA_OPT"]
    os.environ["NUMBA_OPT"] = "3"
    config.reload_config()
    yield
    os.environ["NUMBA_OPT"] = before
    config.reload_config()
