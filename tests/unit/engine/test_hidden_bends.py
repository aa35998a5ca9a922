"""What a whole substep and its halves miss alike, where a force that grows lifts a body."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from interpreted import interpreted, records
from plain_facts import one_row

from lavendersim.engine.error_estimate import PATH
from lavendersim.engine.hidden_bends import make_missed, make_note_loads
from lavendersim.engine.records import dtype
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("compliance", "error_control"), shape_pairs=("sphere_plane",))
MISSED, NOTE = (interpreted(make(SPEC)) for make in (make_missed, make_note_loads))
MASS, RATE, LENGTH = 2.0, 50.0, 0.1  # [kg], of its acceleration [m/s^3], of the substep [s]
HALF = 0.5 * LENGTH


def part(speed: float, begin: float, end: float, bend: float) -> tuple[float, float]:
    """Return its speed after a part that pulls by RATE (t - bend), and the force of its contact."""
    pulled = speed + 0.5 * RATE * ((end - bend) ** 2 - (begin - bend) ** 2)
    return max(pulled, 0.0), max(-pulled, 0.0) * MASS / (end - begin)


def velocity(speed: float) -> Any:
    return one_row(vx=0.0, vy=0.0, vz=speed)


def missed(speeds: tuple[float, float, float], **path: float) -> float:
    row = one_row(**{"load_dt": HALF, **path})
    return float(MISSED(one_row(inv_m=1.0 / MASS, bound=0.1), *map(velocity, speeds), row, HALF))


@pytest.mark.parametrize("phase", np.linspace(0.01, 0.99, 50))
def test_it_is_what_halves_are_off_by_wherever_in_a_substep_a_body_leaves(phase: float) -> None:
    bend = phase * LENGTH
    _, load = part(0.0, -HALF, 0.0, bend)
    middle, first = part(0.0, 0.0, HALF, bend)
    after, last = part(middle, HALF, LENGTH, bend)
    off = 0.5 * RATE * (LENGTH - bend) ** 2 - after
    found = missed((0.0, middle, after), load=load, first_load=first, last_load=last)
    if phase > 0.25:
        assert found == pytest.approx(off, rel=1e-9, abs=1e-12)
    else:
        assert off <= found == pytest.approx(RATE * LENGTH**2 / 32.0, rel=1e-12)


def test_forces_that_jump_are_no_bends() -> None:
    """What ends at once between two substeps, or within one; what an impact or a landing leaves."""
    fall = -10.0
    let_go = (0.0, fall * HALF, fall * LENGTH)
    assert missed(let_go, load=20.0, first_load=0.0, last_load=0.0) == 0.0
    assert missed((0.0, 0.0, fall * HALF), load=20.0, first_load=20.0, last_load=0.0) == 0.0
    assert missed((0.0, 0.0, 0.0), load=20.0, first_load=900.0, last_load=20.0) == 0.0
    assert missed((0.0, 0.0, 0.0), load=20.0, first_load=20.0, last_load=1.0) == 0.0
    assert missed((0.0, 0.0, 0.0), load=20.0, first_load=19.0, last_load=18.0) == 0.0


def test_loads_are_forces_of_what_pushes_and_does_not_give_way() -> None:
    paths = np.zeros(3, dtype(PATH))
    paths["first_load"], paths["last_load"] = 3.0, 4.0
    contacts = [
        one_row(a=0, b=1, lambda_n=0.2, gamma=0.0),
        one_row(a=0, b=1, lambda_n=0.3, gamma=0.0),
        one_row(a=0, b=2, lambda_n=0.4, gamma=0.1),
        one_row(a=0, b=2, lambda_n=0.0, gamma=0.0),
    ]
    NOTE(contacts, 4, records(paths), 0.1)
    assert paths["first_load"].tolist() == [4.0] * 3
    assert paths["last_load"] == pytest.approx([5.0, 5.0, 0.0])
