"""The synthetic traces as fixtures, and the mark for tests that need a graphics driver."""

from __future__ import annotations

import pytest
from synthetic_trace import SyntheticTrace, ball_and_box, single_ball


@pytest.fixture
def two_bodies() -> SyntheticTrace:
    return ball_and_box()


@pytest.fixture
def one_ball() -> SyntheticTrace:
    return single_ball()
