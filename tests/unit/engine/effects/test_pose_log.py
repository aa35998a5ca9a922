"""The log has where a body is and how it is turned; without rotation as it was turned before."""

from __future__ import annotations

import numpy as np
from interpreted import interpreted
from plain_facts import facts, one_row

from lavendersim.engine.effects.pose_log import EFFECT, make
from lavendersim.engine.spec import Spec


def test_a_row_is_position_and_quaternion() -> None:
    body = one_row(x=1.0, y=2.0, z=3.0, qw=4.0, qx=5.0, qy=6.0, qz=7.0)
    for effects, turned in ((("rotation",), [4.0, 5.0, 6.0, 7.0]), ((), [9.0] * 4)):
        row = np.full(7, 9.0)
        interpreted(make(Spec(effects)))(body, row)
        assert row.tolist() == [1.0, 2.0, 3.0, *turned]


def test_it_is_on_where_the_run_is_logged() -> None:
    assert EFFECT.decide(facts()).on
    assert not EFFECT.decide(facts(record=False)).on
