"""Fields of packed contacts lie apart, on whole cache lines, one by one or in groups of eight."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from interpreted import interpreted

from lavendersim.engine.solvers.packed import layout
from lavendersim.engine.solvers.packed.lane_memory import STRIDE
from lavendersim.engine.solvers.packed.lanes import WIDTH
from lavendersim.engine.solvers.packed.layout import HEAD, LINE, allocate_packed, begins, stride
from lavendersim.engine.spec import Spec

FRICTIONAL = Spec(("friction",))
SPECS = {
    "normals": Spec(),
    "blocks": FRICTIONAL,
    "torsion": FRICTIONAL.including("torsional_friction"),
    "rolling": FRICTIONAL.including("rolling_friction"),
    "both": FRICTIONAL.including("rolling_friction", "torsional_friction"),
}
# Numbers of each field, by where it begins: axes have three, TURN_A and TURN_B three axes.
BLOCK = {0: 9, layout.TURN_A: 9, layout.TURN_B: 9}
PARTS = {
    "block": (layout.BLOCK, BLOCK, range(27, layout.BLOCK)),
    "torsion": (
        layout.TORSION,
        {layout.TORSION_A: 3, layout.TORSION_B: 3},
        range(6, layout.TORSION),
    ),
    "roll": (layout.ROLL, {layout.ROLL_A: 6, layout.ROLL_B: 6}, range(12, layout.ROLL)),
    "normal": (
        layout.NORMAL_ALONE,
        {layout.NORMAL: 3, layout.ARM_A: 3, layout.ARM_B: 3},
        range(9, layout.NORMAL_ALONE),
    ),
}


@pytest.mark.parametrize("part", PARTS)
def test_fields_fill_their_part_without_gap_or_overlap(part: str) -> None:
    size, wide, single = PARTS[part]
    taken = [n for begin, count in wide.items() for n in range(begin, begin + count)] + list(single)
    assert sorted(taken) == list(range(size))


@pytest.mark.parametrize("name", SPECS)
def test_parts_come_one_behind_the_other_and_absent_ones_have_none(name: str) -> None:
    found, spec = begins(SPECS[name]), SPECS[name]
    if name == "normals":
        assert set(found) == {layout.NORMAL_ALONE}
        return
    torsion = layout.TORSION if spec.has("torsional_friction") else 0
    roll = layout.ROLL if spec.has("rolling_friction") else 0
    assert found == (layout.BLOCK, layout.BLOCK + torsion, layout.BLOCK + torsion + roll)


@pytest.mark.parametrize("eight", [False, True])
@pytest.mark.parametrize("name", SPECS)
def test_no_two_contacts_share_a_number_and_rows_begin_with_a_cache_line(name, eight) -> None:
    spec = SPECS[name]
    fields, contacts = begins(spec).end, 20
    packed = allocate_packed(spec, 6, contacts, eight)
    place = interpreted(layout.make_place(spec, eight, fields))
    step = WIDTH if eight else 1
    groups = contacts if not eight else contacts // WIDTH
    taken = {place(slot) + k * step for slot in range(groups * step) for k in range(fields)}
    assert len(taken) == groups * step * fields
    assert max(taken) < len(packed.rows) == contacts * stride(spec, eight)
    for array in (packed.rows, packed.state):
        assert array.ctypes.data % (8 * LINE) == 0
        assert not array.any()
    if not eight:
        assert {place(slot) % LINE for slot in range(contacts)} == {0}
    starts = [place(slot) for slot in range(0, groups * step, step)]
    assert {b - a for a, b in pairwise(starts)} == {stride(spec, eight)}


def test_states_have_lines_before_those_of_bodies_for_what_nothing_moves() -> None:
    packed = allocate_packed(FRICTIONAL, 6, 20, True)
    assert len(packed.state) == (HEAD + 6) * STRIDE
    assert len(packed.start) == len(packed.factor) == len(packed.group_of) == 6
    assert len(packed.first) == len(packed.second) == 20 * WIDTH
    assert packed.slot.dtype == np.int64
    assert len(packed.slot) == 20
