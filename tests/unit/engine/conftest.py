"""Random poses and the oracles' folder, for every test of the engine."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "oracle"))


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20250701)
