"""Impacts ahead by the closed form of a gap at constant acceleration, and which are too slow.

Two balls come nearer along x: the gap is phi + v t + a t^2/2, and its first root is when they meet.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np
import pytest
from drawn_contacts import put_vector, random_frame
from interpreted import interpreted, records
from plain_facts import one_row

from lavendersim.engine.approach import CREEP, ELSEWHERE, GUESSED, NEVER, OVERLAP
from lavendersim.engine.foreseen_impacts import (
    CLOSED,
    CURVED,
    FALL,
    FLIGHT,
    GLANCING,
    LAST,
    REBOUNDS,
    make_follow,
    make_foresee,
    make_is_impact,
    make_let_rebound,
)
from lavendersim.engine.record_layout import allocate_bodies, allocate_pairs, contact_dtype
from lavendersim.engine.records import MOTION, PLANE, SPHERE, TOUCHING, dtype
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("impact_order", "restitution"))
TURNS = SPEC.including("rotation")
SLOP, STEP, RADIUS = 1e-6, 0.01, 0.1
HAIR = 1e-9  # to either side of a limit, relative
FORESEE = {spec: interpreted(make_foresee(spec)) for spec in (SPEC, TURNS)}


class Row:
    """A contact of A, a plane or a ball, and a ball B; what moves is B."""

    def __init__(self, spec: Spec = SPEC, **pair: float) -> None:
        self.spec, self.left, self.met = spec, STEP, False
        self.bodies, self.motion = allocate_bodies(spec, 2), np.zeros(2, dtype(MOTION))
        self.bodies["shape"], self.bodies["bound"] = [PLANE, SPHERE], [0.0, RADIUS]
        self.pairs, self.contacts = allocate_pairs(spec, 1), np.zeros(1, contact_dtype(spec))
        for name, value in pair.items():
            self.pairs[name] = value
        self.contact = self.contacts[0]
        self.contact["b"], self.contact["nz"] = 1, 1.0
        self.contact["due"], self.contact["located"] = NEVER, GUESSED

    def moves(self, phi: float, v: float, a: float) -> Row:
        """Let the gap be phi, its rate v, and forces accelerate B by a."""
        self.contact["phi"], self.contact["rate"] = phi, v
        self.motion["vz"][1] = v
        for name in ("dvz", "ahead_z"):
            self.motion[name][1] = a * self.left
        return self

    def foresee(self) -> tuple[bool, bool, float]:
        """Return whether an impact is now, whether the row waits, and when it is due."""
        params = one_row(dt=self.left, timestep=STEP, slop=SLOP)
        arrays = (self.contacts, self.pairs, self.bodies, self.motion)
        contacts, pairs, bodies, motion = (records(array) for array in arrays)
        kernel = FORESEE[self.spec]
        now = kernel(contacts[0], pairs[0], bodies, motion, params, self.met)
        return bool(now), self.contact["waits"] > 0, float(self.contact["due"])


@pytest.mark.parametrize("restitution", [0.0, 0.4])
def test_a_gap_closes_at_its_first_root(restitution: float, rng) -> None:
    """Of fast balls in hard fields: forwards, thrown up and falling back, and too far away."""
    seen = set()
    for _ in range(300):
        row = Row(restitution=restitution)
        row.left = rng.uniform(0.2, 1.0) * STEP
        phi = 10.0 ** rng.uniform(-5.7, -2.0)
        v, a = rng.normal() * 3.0, rng.normal() * 300.0
        roots = np.roots([0.5 * a, v, phi])
        times = sorted(t.real for t in roots if t.imag == 0.0 and t.real > 0.0)
        now, waits, due = row.moves(phi, v, a).foresee()
        assert not now
        if not times or times[0] >= row.left:
            assert due == NEVER
            seen.add("misses")
            continue
        # Faster than the limit: e > 0 or what forces change in a timestep, less of it after a fall.
        speed = sqrt(v * v - 2.0 * a * phi)
        fast = speed > abs(a) * STEP * (GLANCING if phi > FALL else 1.0)
        if restitution:
            fast = fast or 2.0 * restitution * speed > FLIGHT * -a * STEP
        if fast:
            assert waits
            # Digits that numpy's own roots lose where they nearly meet.
            assert due == pytest.approx(times[0], rel=1e-8)
            assert phi + v * due + 0.5 * a * due * due == pytest.approx(0.0, abs=1e-15)
            seen.add("turns" if v > 0.0 else "meets")
        else:
            assert due == NEVER
            seen.add("slow")
    assert seen == {"misses", "meets", "turns", *(() if restitution else ("slow",))}


IS_IMPACT = interpreted(make_is_impact(SPEC))


def test_a_rebound_is_an_impact_where_its_flight_lasts() -> None:
    """It rises for e v/g and falls as long: FLIGHT timesteps, whatever of the step is left."""
    e, gravity = 0.3, 10.0
    least = FLIGHT * STEP * gravity / (2.0 * e)
    for left in (STEP, 0.3 * STEP):
        for share, expected in ((1.0 + HAIR, True), (1.0 - HAIR, False)):
            params = one_row(dt=left, timestep=STEP)
            found = IS_IMPACT(share * least, CREEP, -gravity * left, 1.0, e, params)
            assert found == expected


def test_a_plastic_meeting_is_one_faster_than_forces_change_it_in_a_timestep() -> None:
    most = 2.0
    for left in (STEP, 0.3 * STEP):
        params = one_row(dt=left, timestep=STEP)
        limit = most * STEP / left
        assert IS_IMPACT(limit * (1.0 + HAIR), CREEP, -1.0, most, 0.0, params)
        assert not IS_IMPACT(limit * (1.0 - HAIR), CREEP, -1.0, most, 0.0, params)
    assert not IS_IMPACT(CREEP, CREEP, 0.0, 0.0, 1.0, params)
    assert IS_IMPACT(2.0 * CREEP, CREEP, 0.0, 0.0, 1.0, params)


def test_what_touches_and_approaches_meets_now() -> None:
    """One that the last part ended with meets as fast as it may, whatever forces are."""
    for speed, now in ((0.11, True), (0.09, False)):  # forces change 0.1 m/s
        assert Row().moves(0.0, -speed, -0.1 / STEP).foresee() == (now, False, NEVER)
        row = Row().moves(0.5 * TOUCHING, -speed, -0.1 / STEP)
        row.met = True
        assert row.foresee() == (True, False, NEVER)
    assert Row().moves(0.0, -0.99 * CREEP, 0.0).foresee() == (False, False, NEVER)


def test_one_that_leaves_waits_and_one_that_forces_bring_back_does_not() -> None:
    """It is out of the slop at the end, at phi + v t - a t^2/2, and faster than forces change."""
    change = 0.1
    for share in (1.0 - HAIR, 1.0 + HAIR):
        # v = change: it has phi + v t/2 at the end, more than the slop.
        limit = share * (change + CREEP) / (1.0 - 1e-9)
        row = Row().moves(1e-6, limit, -change / STEP)
        assert row.foresee()[1] == (share > 1.0)
    for share in (1.0 - HAIR, 1.0 + HAIR):
        v = 1.0
        left = share * SLOP / (v - 0.5 * change)
        for restitution, waits in ((0.0, share > 1.0), (0.9, True)):  # what rebounds meets again
            row = Row(restitution=restitution)
            row.left = left
            row.moves(0.0, v, -(0.05 if restitution else 1.0) * change / left)
            assert row.foresee()[1] == waits


def test_a_ball_that_falls_back_is_due_when_its_flight_ends() -> None:
    """2 v/g, once that is FLIGHT timesteps; before that it is a contact of the motion."""
    gravity = 10.0
    for flight, due in ((0.5, True), (1.01 * FLIGHT, True), (0.99 * FLIGHT, False), (1.01, False)):
        v = 0.5 * gravity * flight * STEP
        expected = pytest.approx(flight * STEP, rel=1e-12) if due else NEVER
        row = Row(restitution=1.0).moves(0.0, v, -gravity)
        assert row.foresee()[2] == expected
        # What contacts of its are reckoned to bring is no force of its own.
        held = Row(restitution=1.0).moves(0.0, v, -gravity)
        held.motion["dvz"] = 0.0
        assert held.foresee()[2] == expected


def test_what_parts_for_less_than_the_shortest_flight_lies() -> None:
    """2 v/g against FLIGHT timesteps: an impact of its bodies takes along what lies."""
    gravity = 10.0
    for left in (STEP, 0.3 * STEP):
        for share, phi, lies in ((0.99, 0.0, True), (1.01, 0.0, False), (0.99, 2.0 * SLOP, False)):
            v = share * 0.5 * gravity * FLIGHT * STEP
            for restitution in (0.0, 0.5):  # without a rebound it has not flown
                row = Row(restitution=restitution)
                row.left = left
                row.moves(phi, v, -gravity).foresee()
                assert row.contact["rate"] == (0.0 if lies and restitution else v)


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_what_will_rebound_after_the_part_flies_in_it(restitution: float) -> None:
    """Across half of the slop at 0.1 mm/s, after 5 ms: a row would hold it where it is.

    Without a rebound it is held: that it meets later changes no velocity.
    """
    for left, ahead in ((4e-3, restitution > 0.0), (6e-3, True)):
        row = Row(restitution=restitution)
        row.left = left
        _, waits, due = row.moves(0.5 * SLOP, -1e-4, 0.0).foresee()
        assert waits == ahead
        assert due == (pytest.approx(5e-3, rel=1e-12) if left > 5e-3 else NEVER)


@pytest.mark.parametrize("v", [0.02, 0.06])
def test_what_is_far_inside_has_not_left_by_a_rebound(v: float) -> None:
    """A rope that is too long by itself, whose ends come nearer: it has a row all the same.

    A flight would end within the step of 10 ms, or after it (2 v/|a| = 4 and 12 ms).
    """
    for depth, waits in ((0.9 * OVERLAP, True), (1.1 * OVERLAP, False), (20.0, False)):
        row = Row(restitution=0.5).moves(-depth, v, -10.0)
        assert row.foresee()[1] == waits


def test_a_glance_is_an_impact_at_a_slower_speed() -> None:
    """Past a ball the path of the contact bends: by v^2/r of two balls, and SLOW is GLANCING.

    So it is of what falls through more than FALL.
    """
    change = 0.1
    fall = 1.01 * FALL / SLOP
    for other, gap, due in (
        *((SPHERE, 2, True), (PLANE, 2, False), (SPHERE, 1, False)),
        *((PLANE, fall, True), (PLANE, 0.99 * FALL / SLOP, False)),
    ):
        row = Row()
        row.bodies["shape"][0], row.bodies["bound"][0] = other, RADIUS
        row.moves(gap * SLOP, -0.02, 0.0)  # slower than forces change, faster than GLANCING of it
        row.motion["dvz"] = [0.5 * change, -0.5 * change]
        row.motion["ahead_z"] = 0.0
        row.motion["vx"][1] = 1.0  # v^2/r dt = 0.1 m/s, more than CURVED of what forces change
        assert (row.foresee()[2] == pytest.approx(gap * SLOP / 0.02)) == due
        assert CURVED * change < 1.0 / RADIUS * STEP
        assert GLANCING * change < 0.02


def test_what_turns_may_meet_elsewhere_than_by_the_rate_of_its_gap() -> None:
    """A row that leaves: LAST of the step is a first guess where spin can bring it back.

    Turning bends a gap by w (v + w R) t^2/2, which is its end, phi + v t + a t^2/2, at a root.
    """
    v, a = 0.5, -20.0
    end = 2.0 * SLOP + v * STEP + 0.5 * a * STEP**2
    limit = (sqrt(v * v + 8.0 * RADIUS * end / STEP**2) - v) / (2.0 * RADIUS)
    for spin, due in ((limit * (1.0 + HAIR), LAST * STEP), (limit * (1.0 - HAIR), NEVER)):
        row = Row(TURNS, restitution=0.5).moves(2.0 * SLOP, v, a)
        row.motion["wy"][1] = spin
        assert row.foresee() == (False, True, pytest.approx(due))


def test_a_turning_body_that_another_presses_is_kept_while_it_is_closed() -> None:
    """Up to the slop and CLOSED of what going round moves its surfaces by."""
    spin, v = 10.0, 0.05
    bends = spin * (spin * RADIUS + v) * STEP
    limit = SLOP + CLOSED * bends * STEP
    for share, waits in ((1.0 - HAIR, False), (1.0 + HAIR, True)):
        row = Row(TURNS).moves(share * limit, v, 0.0)
        row.motion["wy"][1] = spin
        assert bends > v
        assert row.foresee()[1] == waits
    # As long as it parts no faster: v = w (v + w R) dt.
    limit = spin**2 * RADIUS * STEP / (1.0 - spin * STEP)
    for share, waits in ((1.0 - 1e-5, False), (1.0 + 1e-5, True)):  # CREEP is a millionth of it
        row = Row(TURNS).moves(0.0, share * limit, 0.0)
        row.motion["wy"][1] = spin
        assert row.foresee()[1] == waits


COHESIVE = SPEC.including("cohesion")
SPRUNG = SPEC.including("compliance", "contact_spring")
WHOLE = SPEC.including("overlooked_points")
COMPLIANT = SPEC.including("compliance")
TURNS_WHOLE = TURNS.including("overlooked_points")
CONTROLLED = SPRUNG.including("error_control")
MORE = COHESIVE, SPRUNG, CONTROLLED, WHOLE, COMPLIANT, TURNS_WHOLE
FORESEE |= {spec: interpreted(make_foresee(spec)) for spec in MORE}


@pytest.mark.parametrize(("spec", "name"), [(COHESIVE, "cohesion"), (WHOLE, "whole")])
def test_what_is_drawn_or_whole_stays_when_it_leaves(spec: Spec, name: str) -> None:
    for value in (0, 1):
        row = Row(spec).moves(0.0, 1.0, 0.0)
        row.pairs[name] = value
        assert row.foresee() == (False, value == 0, NEVER)
    far = Row(COHESIVE, cohesion=1.0).moves(1.01 * SLOP, 1.0, 0.0)
    assert far.foresee()[1]


@pytest.mark.parametrize("whole", [0, 1])
def test_what_a_part_has_shown_to_come_back_waits_for_no_guess(whole: int) -> None:
    """As in `test_what_turns_may_meet_elsewhere_...`: without the guess it would be left out."""
    row = Row(TURNS_WHOLE, restitution=0.5).moves(2.0 * SLOP, 0.5, -20.0)
    row.motion["wy"][1] = 1e3
    row.pairs["whole"] = whole
    assert row.foresee()[1] == (whole == 0)


def test_springs_push_across_a_gap_and_without_an_impact() -> None:
    soft = {"compliance": 1e-4}
    assert Row(SPRUNG, **soft).moves(0.0, -1.0, 0.0).foresee() == (False, False, NEVER)
    assert Row(SPRUNG, **soft).moves(1e-3, -1.0, 0.0).foresee() == (False, False, NEVER)
    assert Row(CONTROLLED, **soft).moves(1e-3, -1.0, 0.0).foresee() == (False, False, NEVER)
    assert Row(COMPLIANT, **soft).moves(1e-3, -1.0, 0.0).foresee() == (False, False, NEVER)
    assert Row(SPRUNG).moves(0.0, -1.0, 0.0).foresee()[0]


FOLLOW = interpreted(make_follow(TURNS))


def test_of_a_pair_that_stays_at_another_point_none_rebounds(rng) -> None:
    """Against sets, pair by pair: of pairs of some rows."""
    kernel, seen = interpreted(make_let_rebound(SPEC)), set()
    for _ in range(50):
        contacts = np.zeros(12, contact_dtype(SPEC))
        contacts["pair"] = np.sort(rng.integers(0, 6, 12))
        contacts["phi"] = rng.choice([0.5, 2.0], 12) * TOUCHING
        contacts["waits"] = before = rng.choice([0, 1, REBOUNDS], 12)
        stays = (before == 0) & (contacts["phi"] <= TOUCHING)
        kept = {*contacts["pair"][stays]}
        leaves = before == REBOUNDS
        gone = leaves & ~np.isin(contacts["pair"], list(kept))
        expected = np.where(gone, 1, np.where(leaves, 0, before))
        assert bool(kernel(records(contacts), 12)) == bool(gone.any())
        assert contacts["waits"].tolist() == expected.tolist()
        seen |= {bool(gone.any()), "kept" if (leaves & ~gone).any() else "none kept"}
    assert seen == {True, False, "kept", "none kept"}


def followed(
    gaps: list[tuple[float, float, bool]], pairs: list[int], spin: float, due: float = NEVER
) -> Any:
    """Return rows of gap, rate along z and whether they wait, once followed."""
    contacts, motion = np.zeros(len(gaps), contact_dtype(TURNS)), np.zeros(2, dtype(MOTION))
    bodies = allocate_bodies(TURNS, 2)
    bodies["shape"], bodies["bound"] = SPHERE, RADIUS
    contacts["b"], contacts["nz"], contacts["pair"] = 1, 1.0, pairs
    contacts["phi"], contacts["rate"], contacts["waits"] = np.array(gaps).T
    contacts["due"] = due
    motion["vz"][1], motion["wx"][1], motion["dvz"][1] = 1.0, spin, -0.5
    rows = records(allocate_pairs(TURNS, 1 + max(pairs)))
    FOLLOW(records(contacts), rows, len(gaps), records(bodies), records(motion), STEP)
    return contacts


def test_a_pair_that_parts_is_due_when_any_point_can_have_closed_a_gap() -> None:
    """At w R + |dv| - v = 2.5 m/s: of its row with the least gap, if that is within the step."""
    spin, rate = 30.0, 30.0 * RADIUS + 0.5 - 1.0
    found = followed([(0.02, 1.0, True), (0.01, 1.0, True), (0.03, 1.0, True)], [0, 0, 0], spin)
    assert found["located"].tolist() == [GUESSED, ELSEWHERE, GUESSED]
    assert found["due"].tolist() == [NEVER, pytest.approx(0.01 / rate), NEVER]
    far = followed([(1.01 * rate * STEP, 1.0, True)], [0], spin)
    assert far["due"].tolist() == [NEVER]
    slow = followed([(1e-3, 1.0, True)], [0], 4.0)  # w R + |dv| < v
    assert slow["due"].tolist() == [NEVER]


def test_a_pair_of_which_a_row_lasts_is_not_followed() -> None:
    """A meeting faster than what forces change lasts as little as one that waits."""
    for rate, pair_is in ((1.0, False), (-0.4, False), (-0.6, True)):  # forces change 0.5 m/s
        rows = [(0.02, 1.0, True), (0.01, rate, False), (0.005, 1.0, True)]
        found = followed(rows, [0, 0, 1], 30.0)
        assert (found["located"][1] == ELSEWHERE) == pair_is
        assert found["located"][2] == ELSEWHERE
        assert found["due"][2] == pytest.approx(0.005 / 2.5)


def test_a_guess_that_comes_sooner_is_kept() -> None:
    assert followed([(0.005, 1.0, True)], [0], 30.0, 1e-3)["due"].tolist() == [1e-3]


def test_what_overlaps_can_have_met_at_once() -> None:
    found = followed([(-1e-6, 1.0, True)], [0], 30.0)
    assert found["due"].tolist() == [0.0]


def test_nothing_that_does_not_turn_is_followed() -> None:
    assert make_follow(SPEC) is None


def test_turning_the_scene_changes_nothing(rng) -> None:
    """Of bodies that turn, along any normal, and with A and B exchanged."""
    for _ in range(50):
        row, phi, v, a = Row(TURNS, restitution=0.2), 10 ** rng.uniform(-6, -2), *rng.normal(size=2)
        row.bodies["shape"], row.bodies["bound"] = SPHERE, [RADIUS, 0.2]
        row.moves(phi, v, 10.0 * a)
        velocities = {name: rng.normal(size=(2, 3)) for name in ("v", "w", "dv", "ahead_")}
        found = set()
        for order in ((0, 1), (1, 0)):
            turned, sign = random_frame(rng), 1.0 if order[0] == 0 else -1.0
            row.contact["waits"], row.contact["due"] = 0, NEVER
            row.contact["a"], row.contact["b"] = order
            put_vector(row.contact, "n", sign * turned @ (0.0, 0.0, 1.0))
            for name, vectors in velocities.items():
                for i in range(2):
                    put_vector(row.motion[i], name, turned @ vectors[i])
            now, waits, due = row.foresee()
            found.add((now, waits, float(f"{due:.9g}")))
        assert len(found) == 1
