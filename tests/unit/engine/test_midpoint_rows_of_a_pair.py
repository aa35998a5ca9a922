"""Rows of a pair that stick do work together: which of them does it is not for statics to say."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import Drawn, drawn, put_vector
from interpreted import interpreted, records

from lavendersim.engine import midpoint_rows
from lavendersim.engine.record_layout import allocate_velocities
from lavendersim.engine.records import MOTION, dtype
from lavendersim.engine.spec import Spec

SPEC = Spec(
    ("contact_midpoint", "friction", "impact_order", "impact_time", "rotation"),
    ("sphere_plane", "sphere_sphere"),
)
PUSH = 0.3  # of the first row along its slip [N s m/s]


class Sticking:
    """Two rows of the same bodies, whose slip at the start is gone at the end."""

    def __init__(self, second: float, pairs: tuple[int, int]) -> None:
        """second: work of the second row on its slip."""
        self.scene: Drawn = drawn(SPEC, np.random.default_rng(8), [(0, 1), (0, 1)], fixed=())
        rows = self.scene.contacts
        rows["pair"], rows["lambda_n"], rows["lasts"], rows["slides"] = pairs, 1.0, 1, 0
        rows["surface_1"] = rows["surface_2"] = 0.0
        self.motion, self.velocities = np.zeros(2, dtype(MOTION)), allocate_velocities(SPEC, 2)
        put_vector(self.motion[1], "v", (0.4, -0.2, 0.1))
        put_vector(self.velocities[0], "v", (0.0, 0.0, 0.0))
        for row, work in zip(rows, (PUSH, second), strict=True):
            frame = np.array([[row[f"{t}{x}"] for x in "xyz"] for t in ("t1", "t2")])
            slip = frame @ (0.4, -0.2, 0.1)
            row["lambda_1"], row["lambda_2"] = work * slip / (slip @ slip)
            put_vector(row, "begin_", slip @ frame)
        for name in ("v", "w"):
            for row in self.velocities:
                put_vector(row, name, (0.0, 0.0, 0.0))

    def begin(self) -> Any:
        kernel = interpreted(midpoint_rows.make_begin_slip(SPEC))
        kernel(records(self.scene.contacts), 2, records(self.velocities), records(self.motion))
        return self.scene.contacts["slides"].tolist()

    def resist(self) -> Any:
        kernel = interpreted(midpoint_rows.make_resist(SPEC))
        more = kernel(records(self.scene.contacts), 2, records(self.velocities))
        slides = self.scene.contacts["slides"].tolist()
        assert more == (1 in slides)
        return slides


@pytest.mark.parametrize("of", [Sticking.begin, Sticking.resist])
def test_it_is_the_sum_over_the_rows_of_a_pair_that_friction_does_no_work_by(of: Any) -> None:
    """The mean slip is half of that at the start: its work has the sign of lambda_t . s_0."""
    for second, slides in ((-2.0 * PUSH, [0, 0]), (-0.5 * PUSH, [1, 0]), (PUSH, [1, 1])):
        assert of(Sticking(second, (3, 3))) == slides
    # Of another pair it is its own.
    for second, slides in ((-2.0 * PUSH, [1, 0]), (PUSH, [1, 1])):
        assert of(Sticking(second, (3, 4))) == slides
    assert of(Sticking(0.5 * PUSH, (3, 4))) == [1, 1]
