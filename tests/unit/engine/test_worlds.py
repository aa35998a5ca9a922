"""Worlds that advance in one call have the bits that each has alone, on any number of threads."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from lavendersim.engine.engine import Engine, Rows
from lavendersim.engine.records import ROWS_FULL, RUNNING
from lavendersim.engine.worlds import Worlds
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of_cell
from tests.drop_config import SIX

STEPS, BLOCK = 100, 64  # a block of rows is full before the steps are done


def engines() -> list[Engine]:
    """Return engines of one plan at their starts; the ball has met the floor before the end."""
    cells = load_experiment_text(SIX, "worlds.yaml").cells()
    plans = [plan_of_cell(cell) for cell in cells]
    spec = plans[0].spec
    assert all(plan.spec == spec for plan in plans)
    return [build(cell.config, spec).engine(spec, BLOCK) for cell in cells]


def assert_same_rows(one: Rows, other: Rows) -> None:
    """Rows have room behind their columns for the caller: columns are compared."""
    for mine, others in zip(one, other, strict=True):
        names: Any = mine.dtype.names
        for name in names or [...]:
            assert mine[name].tobytes() == others[name].tobytes(), name


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_every_world_has_the_bits_that_it_has_alone(threads: int) -> None:
    alone, together = engines(), engines()
    worlds = Worlds(together)
    shared = [np.shares_memory(engine.log.pose, together[0].log.pose.base) for engine in together]
    assert shared == [True] * 6
    together[2]._grow_contacts(64)  # gets arrays of its own
    for steps in (0, STEPS, STEPS - BLOCK + 1):
        statuses = [engine.advance(steps) for engine in alone]
        assert worlds.advance(steps, threads) == statuses
        for one, other in zip(alone, together, strict=True):
            assert one.counters["step"] == other.counters["step"]
            assert_same_rows(one.take_rows(), other.take_rows())
        assert statuses == [ROWS_FULL if steps == STEPS else RUNNING] * 6
    bounced = [engine.velocities["vz"][1] for engine in together]
    # They have met the floor: by e they differ, and by mass to round-off of some steps alone.
    assert len(np.unique(np.round(bounced, 12))) == 2


def test_what_differs_in_more_than_numbers_is_refused() -> None:
    with pytest.raises(ValueError, match="no worlds"):
        Worlds([])
    one, other = engines()[:2]
    other._grow_contacts(64)
    with pytest.raises(ValueError, match="arrays of equal shapes"):
        Worlds([one, other])
