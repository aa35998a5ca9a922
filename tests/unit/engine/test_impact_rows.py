"""Rows of an impact are those that a path of pressed contacts joins to a meeting, by a search."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from interpreted import interpreted, records

from lavendersim.engine.approach import FAR, GUESSED, MEETS
from lavendersim.engine.impact_rows import FLUSH, make_keep_present, make_mark_impact
from lavendersim.engine.record_layout import allocate_bodies, allocate_pairs, contact_dtype
from lavendersim.engine.records import MOTION, SPHERE, dtype
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("impact_order",))
SPRINGS = Spec(effects=("compliance", "contact_spring", "impact_order"))
TURNING = Spec(effects=("impact_order", "restitution", "rotation"))
SLOP = 1e-4
PARAMS = SimpleNamespace(slop=SLOP, timestep=0.01)


def rows_of(pairs, spec: Spec = SPEC, bodies: int = 8, fixed=(0,)):
    contacts, found = np.zeros(len(pairs), contact_dtype(spec)), allocate_bodies(spec, bodies)
    found["inv_m"], found["shape"], found["bound"] = 1.0, SPHERE, 0.1
    found["inv_m"][list(fixed)] = 0.0
    contacts["a"], contacts["b"] = np.array(pairs).T
    contacts["located"] = FAR
    return contacts, found


def marked(contacts, bodies, spec: Spec = SPEC, pairs=(), spin: float = 0.0):
    """Return how many rows take part, and which, with the bodies of the impact."""
    motion = np.zeros(len(bodies), dtype(MOTION))
    motion["in_impact"] = 1  # of the impact before
    if spin:
        motion["wy"], motion["vx"] = spin, 1.0
    mark = interpreted(make_mark_impact(spec))
    state = SimpleNamespace(
        contacts=records(contacts),
        pairs=records(pairs),
        bodies=records(bodies),
        motion=records(motion),
    )
    count = mark(state, len(contacts), PARAMS)
    taking = set(np.flatnonzero(contacts["waits"] == 0))
    assert count == len(taking)
    return taking, set(np.flatnonzero(motion["in_impact"]))


def reached(contacts, bodies, able) -> set[int]:
    """Return rows that a path of able rows over movable bodies joins to a meeting."""
    found: set[int] = set()
    meeting = {int(i) for c in contacts if c["located"] == MEETS for i in (c["a"], c["b"])}
    movable = {i for i in meeting if bodies["inv_m"][i] > 0.0}
    while True:
        more = {
            k for k, c in enumerate(contacts) if able[k] and {int(c["a"]), int(c["b"])} & movable
        }
        if more == found:
            return found
        found = more
        ends = {int(contacts[k][side]) for k in more for side in "ab"}
        movable |= {i for i in ends if bodies["inv_m"][i] > 0.0}


def test_an_impact_is_handed_on_as_far_as_contacts_press(rng) -> None:
    sizes = set()
    for _ in range(200):
        pairs = [tuple(sorted(rng.permutation(8)[:2])) for _ in range(9)]
        contacts, bodies = rows_of(pairs)
        contacts["phi"] = rng.choice([0.0, 0.5 * SLOP, 2.0 * SLOP], 9, p=[0.6, 0.2, 0.2])
        contacts["rate"] = rng.choice([0.0, -1.0, 1.0], 9, p=[0.6, 0.2, 0.2])
        contacts["waits"] = rng.integers(0, 2, 9)
        able = (contacts["phi"] <= 0.0) | ((contacts["phi"] <= SLOP) & (contacts["waits"] == 0))
        able &= contacts["rate"] <= 0.0
        first = int(rng.integers(9))
        contacts["located"][first] = MEETS
        expected = reached(contacts, bodies, able)
        taking, moved = marked(contacts, bodies)
        assert taking == expected
        ends = {int(contacts[k][side]) for k in taking for side in "ab"}
        assert moved == ends | {int(contacts[first][side]) for side in "ab"}
        sizes.add(len(taking))
    assert {0, 1, 2, 3, 4, 5} <= sizes


def test_a_floor_hands_nothing_on() -> None:
    """A ball lands beside a stack on the same floor, and another on top of it."""
    contacts, bodies = rows_of([(0, 1), (0, 2), (2, 3)])
    contacts["located"][0] = MEETS
    assert marked(contacts, bodies) == ({0}, {0, 1})
    contacts["located"] = [FAR, FAR, MEETS]
    assert marked(contacts, bodies) == ({1, 2}, {0, 2, 3})


def test_what_a_spring_presses_on_takes_no_part() -> None:
    contacts, bodies = rows_of([(0, 1), (1, 2)], SPRINGS)
    pairs = allocate_pairs(SPRINGS, 2)
    contacts["located"], contacts["pair"] = [MEETS, FAR], [0, 1]
    assert marked(contacts, bodies, SPRINGS, pairs)[0] == {0, 1}
    pairs["compliance"][1] = 1e-4
    assert marked(contacts, bodies, SPRINGS, pairs)[0] == {0}


def test_what_joints_hold_takes_part_wherever_its_ends_are() -> None:
    spec = SPEC.including("joint")
    for bilateral, taking in ((0, {0}), (1, {0, 1})):
        contacts, bodies = rows_of([(0, 1), (1, 2)], spec)
        contacts["located"], contacts["phi"] = [MEETS, FAR], [0.0, 100.0 * SLOP]
        contacts["bilateral"] = [0, bilateral]
        assert marked(contacts, bodies, spec)[0] == taking


@pytest.mark.parametrize("e", [0.0, 0.5])
def test_points_of_a_face_meet_together_and_the_edge_it_turns_about_holds(e: float) -> None:
    """Of one pair: the edge parts by half of what a step bends, a point meets, others are near."""
    contacts, bodies = rows_of([(0, 1)] * 5 + [(0, 2)], TURNING)
    pairs = allocate_pairs(TURNING, 1)
    pairs["restitution"] = e
    spin, bent = 3.0, 3.0 * 1.0 * PARAMS.timestep  # going round: w v over a step [m/s]
    contacts["located"] = [GUESSED, MEETS, *[GUESSED] * 4]
    contacts["phi"] = np.array([-1.0, 0.0, 0.9 * FLUSH, 1.1 * FLUSH, -1.0, 0.9 * FLUSH]) * SLOP
    contacts["rate"] = [0.5 * bent, -1.0, -3.0, -3.0, 2.0 * bent, -3.0]
    contacts["waits"] = [1, 0, 1, 1, 1, 1]
    taking, _ = marked(contacts, bodies, TURNING, pairs, spin)
    # What rebounds leaves point by point; points that are not flush and those of others stay out.
    assert taking == ({1} if e > 0.0 else {0, 1, 2})
    if e == 0.0:
        assert contacts["phi"][2] <= 1e-9  # its gap counts as closed: an instant would not close it


@pytest.mark.parametrize("waits", [[0, 0, 0, 0], [1, 0, 1, 0], [0, 1, 1, 1], [1, 1, 1, 1]])
def test_rows_that_do_not_wait_are_kept_in_their_order(waits: list[int]) -> None:
    contacts, _ = rows_of([(0, 1)] * 4)
    contacts["waits"], contacts["lambda_n"] = waits, [1.0, 2.0, 3.0, 4.0]
    kept = interpreted(make_keep_present(SPEC))(records(contacts), 4)
    expected = [k + 1.0 for k in range(4) if waits[k] == 0]
    assert contacts["lambda_n"][:kept].tolist() == expected
