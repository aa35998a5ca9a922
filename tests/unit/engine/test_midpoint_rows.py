"""Rows at the middle of a step: the mean of both ends' velocities respects what lasts.

With b of `shift` the row asks J(q_m) v_1 + b >= 0, so at equality
    J(q_m) (v_0 + v_1) = min(J(q_0) v_0, 0)
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import Drawn, drawn, put_vector, random_frame, stacked
from interpreted import interpreted, records
from plain_facts import one_row

from lavendersim.engine import free_flight, midpoint_rows
from lavendersim.engine.midpoint_rows import (
    AJAR,
    BEFORE,
    CALM,
    FORCED,
    SAME,
    SLIDES,
    STILL,
    TURNED,
)
from lavendersim.engine.record_layout import allocate_bodies, allocate_velocities
from lavendersim.engine.records import MOTION, PLANE, SPHERE, dtype
from lavendersim.engine.spec import Spec

EFFECTS = ("contact_midpoint", "friction", "impact_order", "impact_time", "rotation")
SPEC = Spec(EFFECTS, ("sphere_plane", "sphere_sphere"))
SPRUNG = SPEC.including("compliance", "contact_spring")
MIXED = SPEC.including("frictionless_contact")
SWEPT = SPEC.including("fast_bodies")
STRAIGHT = SPEC.without("friction", "rotation")
DT, SLOP, HAIR = 0.02, 1e-5, 1e-9
PARAMS = one_row(dt=DT, timestep=DT, slop=SLOP)


class Row:
    """A contact of two bodies and their velocities as the step begins."""

    def __init__(self, rng: np.random.Generator, spec: Spec = SPEC) -> None:
        self.spec, self.scene = spec, drawn(SPEC, rng, [(0, 1)], fixed=())
        if spec is not SPEC:
            self.scene = drawn(spec, rng, [(0, 1)], fixed=())
        self.lead = records(self.scene.velocities)
        self.row, self.contact = self.scene.contacts[0], records(self.scene.contacts)[0]
        self.contact.target = self.contact.phi = 0.0

    def begins(self, **values: float) -> Row:
        for name, value in values.items():
            self.contact[name] = value
        return self

    @property
    def w(self) -> np.ndarray:
        """n, t1 and t2 of what the velocities of the start are at the middle."""
        found: np.ndarray = self.scene.jacobian @ self.scene.motion
        return found

    def turned_by(self, share: float) -> float:
        """Let J(q_m) v_0 be `share`, whatever it is at the start; return it."""
        v = np.linalg.pinv(self.scene.jacobian) @ (share, 0.0, 0.0)
        for velocity, own in zip(self.scene.velocities, v.reshape(-1, 6), strict=True):
            put_vector(velocity, "v", own[:3])
            put_vector(velocity, "w", own[3:])
        return share

    def shift(self, dt: float = DT) -> Row:
        kernel = interpreted(midpoint_rows.make_shift(self.spec))
        motion = records(np.zeros(2, dtype(MOTION)))
        kernel(self.contact, None, self.lead, motion, one_row(dt=dt, timestep=DT, slop=SLOP))
        return self


def test_the_mean_normal_velocity_of_what_lasts_is_what_approaches_at_the_start(rng) -> None:
    for begin in (-0.5 * CALM, 0.0, 0.5 * CALM):
        row = Row(rng).begins(begin_n=begin).shift()
        assert row.contact.lasts == 1
        # v_1 = -target along n.
        mean = row.w[0] - row.contact.target
        assert mean == pytest.approx(min(begin, 0.0), abs=1e-14)
        assert row.contact.middle_n == pytest.approx(row.w[0], abs=1e-14)


def test_a_contact_lasts_that_begins_no_faster_than_forces_or_turning_change_it(rng) -> None:
    """By FORCED of forces in a timestep, approaching, and TURNED of b, in both directions.

    Parting, also by BEFORE of what turning adds in half a step: begin <= B (middle - begin) + CALM.
    """
    for left in (DT, 0.5 * DT):
        for forced, middle in ((3.0, 0.0), (0.0, 2.0), (3.0, 2.0)):
            for sign in (-1.0, 1.0):
                # begin = -(F forced + T |b| + CALM), b = middle - min(begin, 0)
                gain = FORCED * forced * DT / left if sign < 0.0 else 0.0
                limit = gain + TURNED * middle + CALM
                if sign < 0.0:
                    limit /= 1.0 - TURNED
                else:
                    limit = max(limit, (BEFORE * middle + CALM) / (1.0 + BEFORE))
                for share in (1.0 - HAIR, 1.0 + HAIR):
                    row = Row(rng)
                    row.turned_by(middle)
                    row.begins(begin_n=sign * share * limit, dv_n=-forced).shift(left)
                    assert row.contact.lasts == (share < 1.0), (forced, middle, sign)


def test_what_a_step_that_does_not_last_leaves_lasts_in_the_next(rng) -> None:
    """Its edge turns evenly: at the end it parts by twice what half a step adds then."""
    for turns, lasts in ((2.0, 1), (3.0, 0)):
        row = Row(rng)
        row.turned_by(turns + 1.0)
        row.begins(begin_n=turns, dv_n=-1.0).shift()
        assert row.contact.lasts == lasts


def test_a_row_that_does_not_last_is_left_alone(rng) -> None:
    row = Row(rng).begins(target=0.7, begin_n=-100.0, lasts=1, surface_1=0.1).shift()
    assert (row.contact.lasts, row.contact.target, row.contact.surface_1) == (0, 0.7, 0.1)


def test_a_gap_that_turning_opens_is_to_be_closed(rng) -> None:
    """Up to AJAR of what turning moves the surfaces by: phi - slop over dt, in place of its own."""
    for share in (1.0 - HAIR, 1.0 + HAIR):
        row = Row(rng)
        b = row.turned_by(0.5)
        gap = share * AJAR * DT * b
        row.begins(begin_n=0.0, phi=SLOP + gap, target=9.0).shift()
        assert row.contact.lasts == (share < 1.0)
        assert row.contact.target == (pytest.approx(gap / DT + b) if share < 1.0 else 9.0)


@pytest.mark.parametrize("axis", "xyz")
def test_a_swept_gap_is_no_gap_of_the_two_that_last(axis: str, rng) -> None:
    for aside, lasts in ((0.0, 1), (1e-3, 0)):
        row = Row(rng, SWEPT)
        row.turned_by(0.5)
        row.begins(begin_n=0.0, phi=SLOP + 1e-4, **{f"at_t{axis}": -aside}).shift()
        assert row.contact.lasts == lasts
        closed = Row(rng, SWEPT)
        closed.turned_by(0.5)
        assert closed.begins(begin_n=0.0, at_tz=aside).shift().contact.lasts == 1


@pytest.mark.parametrize("slides", [0, 1])
def test_friction_is_against_the_mean_slip_or_takes_away_that_of_the_start(slides, rng) -> None:
    """J_t v_0 added to the row makes it ask for J_t (v_0 + v_1); sticking, less the slip before."""
    row, begin = Row(rng), rng.normal(size=3)
    row.begins(begin_n=0.0, slides=slides, surface_1=0.3, surface_2=-0.2)
    put_vector(row.row, "begin_", begin)
    row.shift()
    frame = [np.array([row.row[f"{axis}{x}"] for x in "xyz"]) for axis in ("t1", "t2")]
    own = np.array([0.3, -0.2])
    expected = own + row.w[1:] + own
    if not slides:
        expected -= [t @ begin for t in frame]
    found = row.contact.surface_1, row.contact.surface_2
    np.testing.assert_allclose(found, expected, atol=1e-14)
    assert row.contact.slides == 2 * slides


def test_rows_without_friction_have_no_slip(rng) -> None:
    row = Row(rng, MIXED).begins(begin_n=0.0, frictional=0, slides=1).shift()
    assert (row.contact.surface_1, row.contact.slides) == (0.0, 1)


def test_a_spring_lasts_whatever_meets_it(rng) -> None:
    """Its row is that of the spring's law at the velocity of the middle; see `contact_spring`."""
    row = Row(rng, SPRUNG)
    middle = row.w[0]
    row.begins(begin_n=-100.0, phi=-1e-3, spring_compliance=1e-4, damping_ratio=0.0).shift()
    gamma = 4.0 * 1e-4 / DT**2
    assert row.contact.lasts == 1
    assert row.contact.gamma == pytest.approx(gamma, rel=1e-14)
    assert row.contact.target == pytest.approx(middle - gamma * DT * 1e-3 / 1e-4, rel=1e-13)


LASTING = interpreted(midpoint_rows.make_lasting(SPRUNG))


def lasts(**values: float) -> bool:
    row = Row(np.random.default_rng(2), SPRUNG).begins(**values)
    contact = row.contact
    contact.slides, contact.jumps = 7, 7
    motion = records(np.zeros(2, dtype(MOTION)))  # no torque acts: spins are those before
    for i in range(2):
        motion[i].wx, motion[i].wy, motion[i].wz = row.lead[i].wx, row.lead[i].wy, row.lead[i].wz
    LASTING(contact, None, row.lead, motion, PARAMS)
    assert (contact.slides, contact.jumps) == (0, 0)
    assert contact.begin_n == contact.middle_n == contact.v_n_pre - contact.dv_n
    return bool(contact.lasts)


def test_a_row_of_the_start_lasts_where_it_is_closed_and_calm() -> None:
    assert lasts(v_n_pre=-1.0, dv_n=-1.0)
    assert lasts(v_n_pre=-1.0, dv_n=-1.0, phi=SLOP)
    assert not lasts(v_n_pre=-1.0, dv_n=-1.0, phi=SLOP * (1.0 + HAIR))
    for share in (1.0 - 1e-6, 1.0 + 1e-6):  # CALM has ten digits beside 1 m/s
        begin = share * (FORCED + CALM)
        assert lasts(v_n_pre=-1.0 - begin, dv_n=-1.0) == (share < 1.0)
        assert lasts(v_n_pre=share * CALM, dv_n=0.0) == (share < 1.0)
    assert lasts(v_n_pre=-9.0, dv_n=0.0, spring_compliance=1e-4)


@pytest.mark.parametrize("axis", "xyz")
@pytest.mark.parametrize("twisted", [0, 1])
@pytest.mark.parametrize("c", [0.0, 1e-4])
def test_what_a_torque_adds_is_no_approach_of_the_start(axis: str, twisted: int, c: float) -> None:
    """v_n before forces is J v_0, whatever a force off the centre adds to the spin of the step.

    The row of a spring that is not pressed asks v_1 + J v_0 + gamma lambda >= 0.
    """
    row = Row(np.random.default_rng(3), SPRUNG)
    row.begins(phi=0.0, dv_n=0.0, spring_compliance=c, damping_ratio=0.0)
    row.turned_by(0.0)  # J v_0: at rest
    motion = records(np.zeros(2, dtype(MOTION)))
    for i in range(2):
        for name in ("vx", "vy", "vz", "wx", "wy", "wz"):
            motion[i][name] = row.lead[i][name]
    row.lead[twisted][f"w{axis}"] += 1.0
    row.contact.v_n_pre = (row.scene.jacobian @ row.scene.motion)[0]
    assert abs(row.contact.v_n_pre) > CALM
    row.contact.target = row.contact.v_n_pre  # of a spring, as `capture` leaves it
    LASTING(row.contact, None, row.lead, motion, PARAMS)
    assert row.contact.lasts == 1
    assert abs(row.contact.begin_n) < 1e-13  # sums of a dozen numbers near 1
    assert c == 0.0 or abs(row.contact.target) < 1e-13


IS_MOVING = interpreted(midpoint_rows.make_is_moving(SPEC))


def is_moving(shape: int = SPHERE, **motion: float) -> bool:
    bodies, rows = allocate_bodies(SPEC, 2), np.zeros(2, dtype(MOTION))
    bodies["shape"][1], bodies["bound"] = shape, 0.5
    for name, value in motion.items():
        rows[name][1] = value
    return bool(IS_MOVING(records(bodies), records(rows)))


def test_what_moves_slower_than_solves_leave_is_still() -> None:
    for share, moves in ((1.0 - HAIR, False), (1.0 + HAIR, True)):
        for axis in "xyz":
            assert is_moving(**{f"v{axis}": share * STILL}) == moves
            assert is_moving(**{f"w{axis}": 2.0 * share * STILL}) == moves  # 0.5 m
        assert is_moving(vx=0.6 * share * STILL, vz=-0.8 * share * STILL) == moves
    assert not is_moving(PLANE, wx=1.0)
    assert is_moving(PLANE, vx=1.0)


BEGIN_SLIP = interpreted(midpoint_rows.make_begin_slip(SPEC))


class Slip:
    """A contact with a slip along its tangents at the start, and one at the end."""

    def __init__(self, before: Any, after: Any, **values: float) -> None:
        self.scene: Drawn = drawn(SPEC, np.random.default_rng(5), [(0, 1)], fixed=())
        self.contact = records(self.scene.contacts)[0]
        self.contact.surface_1 = self.contact.surface_2 = 0.0
        for name, value in values.items():
            self.contact[name] = value
        inverse = np.linalg.pinv(self.scene.jacobian)
        motion, velocities = np.zeros(2, dtype(MOTION)), allocate_velocities(SPEC, 2)
        for rows, slip in ((motion, before), (velocities, after)):
            v = (inverse @ (0.0, *slip)).reshape(-1, 6)
            for row, own in zip(rows, v, strict=True):
                put_vector(row, "v", own[:3])
                put_vector(row, "w", own[3:])
        assert abs(self.scene.jacobian @ stacked(velocities) - (0.0, *after)).max() < 1e-12
        arrays = records(self.scene.contacts), 1, records(velocities), records(motion)
        self.turns = bool(BEGIN_SLIP(*arrays))
        row = self.scene.contacts[0]
        along = (np.array([row[f"{t}{x}"] for x in "xyz"]) for t in ("t1", "t2"))
        found = np.array([row[f"begin_{x}"] for x in "xyz"])
        self.begin = [float(t @ found) for t in along]


def test_it_slides_throughout_where_its_slip_is_so_many_times_its_change() -> None:
    for share, slides in ((1.0 + HAIR, 1), (1.0 - HAIR, 0)):
        slip = Slip((share * SLIDES, 0.0), (share * SLIDES - 1.0, 0.0), lambda_1=-1.0, lambda_2=0.0)
        assert slip.contact.slides == slides
        assert slip.begin == pytest.approx([share * SLIDES, 0.0], abs=1e-12)
        assert not slip.turns


def test_friction_that_would_do_work_on_the_slip_counts_in_the_mean() -> None:
    for one, two, slides in ((0.0, 1.0, 1), (0.0, -1.0, 0), (-1.0, 1.1, 1), (-1.1, 1.0, 0)):
        slip = Slip((0.1, 0.1), (3.0, 0.0), lambda_1=one, lambda_2=two)
        assert slip.contact.slides == slides


def test_a_moving_surface_is_part_of_the_slip() -> None:
    still = Slip((0.0, 0.0), (0.0, 0.1), surface_1=4.0, surface_2=3.0, lambda_n=0.0)
    assert still.begin == pytest.approx([4.0, 3.0], abs=1e-12)
    assert still.contact.slides == 1


def test_a_slip_that_turns_aside_turns_the_friction() -> None:
    """Across the slip by more than what solves leave, and only of a contact that pushes."""
    for share, turns in ((1.0 - 1e-3, False), (1.0 + 1e-3, True)):  # digits of a pseudo-inverse
        aside = share * SAME
        assert Slip((0.6, 0.8), (0.6 - 0.8 * aside, 0.8 + 0.6 * aside)).turns == turns
    assert not Slip((0.6, 0.8), (0.3, 0.4)).turns
    assert not Slip((0.6, 0.8), (0.7, 0.8), lambda_n=0.0).turns


def test_nothing_slips_without_friction() -> None:
    assert midpoint_rows.make_begin_slip(STRAIGHT) is None


WIDEN = interpreted(free_flight.make_widen(SPEC))


def widened(**values: float) -> float:
    row = Row(np.random.default_rng(4)).begins(**{"begin_n": 0.0, "dv_n": 0.0, **values})
    WIDEN(row.contact, PARAMS)
    return float(row.contact.target)


def test_a_gap_that_turning_opens_asks_for_less() -> None:
    """phi + dt (v + b) > 0 where v is the mean of what flies: then it asks for no push at all."""
    opens = 0.5
    assert widened(middle_n=opens, phi=SLOP, target=0.2) == 0.2
    assert widened(middle_n=-opens, phi=1.0, target=0.2) == 0.2
    for share in (1.0 - 1e-7, 1.0 + 1e-7):
        mean = -opens - (SLOP + 1e-3) / DT * share
        found = widened(middle_n=opens, phi=1e-3, target=0.2, v_n_pre=mean + 0.1, dv_n=0.2)
        # v_n + target >= 0 holds without a push where the target is -v_n; and b on top of it.
        expected = max(0.2, -(mean + 0.1)) if share < 1.0 else 0.2
        # What holds without a push has room for round-off: a billionth of a millimetre a second,
        # and as much of its speed, which is below 2 m/s.
        room = 1e-12 * (1.0 + abs(mean + 0.1)) if share < 1.0 else 0.0
        assert found == pytest.approx(expected + opens + room, abs=4e-16)
    assert widened(middle_n=opens, phi=1.0, target=0.2, v_n_pre=-0.1) == 0.2 + opens


def test_frames_do_not_matter(rng) -> None:
    """Turned and with A and B exchanged a row asks for the same."""
    for _ in range(5):
        row = Row(rng).begins(begin_n=0.0)
        twin = Row(rng).begins(begin_n=0.0)
        turned = random_frame(rng)
        for name in ("", "n", "t1", "t2", "ra", "rb"):
            put_vector(twin.row, name, turned @ [row.row[f"{name}{x}"] for x in "xyz"])
        twin.row["a"], twin.row["b"] = 1, 0
        for name in ("n", "t1", "t2"):
            put_vector(twin.row, name, -turned @ [row.row[f"{name}{x}"] for x in "xyz"])
        for one, other in (("ra", "rb"), ("rb", "ra")):
            put_vector(twin.row, one, turned @ [row.row[f"{other}{x}"] for x in "xyz"])
        for k, v in enumerate(row.scene.velocities):
            for prefix in ("v", "w"):
                own = turned @ [v[f"{prefix}{x}"] for x in "xyz"]
                put_vector(twin.scene.velocities[k], prefix, own)
        row.shift()
        twin.shift()
        for name in ("target", "surface_1", "surface_2", "middle_n"):
            assert twin.contact[name] == pytest.approx(row.contact[name], abs=1e-13)
