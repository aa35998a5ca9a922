"""Substeps are as long as their accuracy allows, made whole and in halves, and taken back whole."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from ball_on_ball import REACH, angle_of, ball_on_ball, pendulum
from interpreted import interpreted, records
from plain_facts import one_row

from lavendersim.engine import memory, step_doubling
from lavendersim.engine.record_layout import (
    allocate_bodies,
    allocate_drives,
    allocate_velocities,
    step_row_dtype,
)
from lavendersim.engine.records import DIVERGED, INACCURATE, KNOT, dtype
from lavendersim.engine.spec import Spec
from lavendersim.engine.step_doubling import (
    AT_ONCE,
    CANCELS,
    CAUTION,
    FIRST_HALF,
    GO_ON,
    GROW,
    MISSED,
    MOST_PARTS,
    MOST_SUBSTEPS,
    NOTHING,
    SECOND_HALF,
    SHRINK,
    STEP_ENDS,
    WHOLE,
)

SPEC = Spec(effects=("error_control", "impact_order", "rotation", "step_log", "warm_start"))
DURATION, STEP, ACCURACY = 2.0, 0.1, 1e-6
JUDGE = interpreted(step_doubling.make_judge(SPEC))


def params(**values: float) -> Any:
    known = {"timestep": STEP, "dt": STEP, "duration": DURATION, "accuracy": ACCURACY}
    return one_row(**{**known, "smallest_timestep": 1e-3, "tolerance": 1e-9, **values})


def judged(error: float, floor: float = 0.0, **record: float) -> tuple[bool, float, float]:
    """Return whether a substep is kept, what is proposed next, and what is tried behind a kink."""
    length = record.get("length", 0.01)
    known = {"before": 0.0, "end": length, "length": length, "spent": 0.0, "error": 0.0}
    row = one_row(**{**known, "proposed": 0.0, "smooth": 0.0, **record})
    kept = bool(JUDGE(row, params(), error, floor))
    assert np.array_equal(row.error, error, equal_nan=True)
    return kept, float(row.proposed), float(row.smooth)


OWN = CANCELS * ACCURACY * 0.01 / DURATION  # the share of a substep of 0.01 s
# Of what the run may spend so far, beside CANCELS times its smooth motion.
ONCE = AT_ONCE * ACCURACY * (1.0 + CANCELS * 0.01 / DURATION)


def test_the_next_substep_has_the_error_that_it_may_have() -> None:
    """Of local order 2 the error goes with the square of the length, at a share that is fixed."""
    for share in (0.3, 0.9, 1.0):
        kept, proposed, smooth = judged(share * OWN)
        assert kept
        assert proposed == smooth == pytest.approx(CAUTION * 0.01 / np.sqrt(share), rel=1e-12)
    for error in (0.0, 1e-6 * OWN):
        assert judged(error) == (True, GROW * 0.01, GROW * 0.01)
    # The end of the step cut it short.
    assert judged(0.1 * OWN, proposed=0.5) == (True, 0.5, 0.5)
    assert judged(OWN, proposed=0.5)[1] == pytest.approx(CAUTION * 0.01)


def test_a_kink_may_spend_a_share_of_what_is_left_and_the_next_is_tried_as_long() -> None:
    assert ONCE > OWN
    for share, kept in ((0.999, True), (1.001, False)):
        assert judged(share * ONCE)[0] == kept
    error = 0.9 * ONCE
    assert judged(error, smooth=0.03) == (True, 0.03, 0.01)
    _, proposed, smooth = judged(error, smooth=0.015)  # it was no kink
    assert smooth == 0.01
    assert proposed == pytest.approx(CAUTION * 0.01 * np.sqrt(OWN / error), rel=1e-12)
    # What is spent is no longer there, and earlier substeps have had no error.
    assert not judged(error, spent=ACCURACY)[0]
    assert judged(3.0 * ONCE, before=DURATION - 0.01)[0]


def test_one_that_is_taken_back_shrinks_by_as_much_as_it_is_off() -> None:
    for share in (1.5, 4.0, 30.0, 1e9):
        kept, proposed, _ = judged(share * ONCE)
        factor = max(SHRINK, min(CAUTION / np.sqrt(share), 0.5))
        assert not kept
        assert proposed == pytest.approx(0.01 * factor, rel=1e-12)
    for error in (np.inf, np.nan):
        assert judged(error) == (False, SHRINK * 0.01, 0.0)


def test_an_error_below_what_solves_leave_says_nothing() -> None:
    assert judged(0.99 * 30.0 * ONCE, 30.0 * ONCE)[0]
    assert not judged(1.01 * 30.0 * ONCE, 30.0 * ONCE)[0]


class Substeps:
    """A body, whose velocity and place the halves and the whole are given."""

    def __init__(self, spec: Spec = SPEC, **values: float) -> None:
        self.spec, self.params = spec, params(**values)
        bodies, velocities = allocate_bodies(spec, 1), allocate_velocities(spec, 1)
        bodies["inv_m"], bodies["bound"] = 1.0, 1.0
        if "qw" in bodies.dtype.names:
            bodies["qw"] = 1.0
        self.bodies, self.velocities = bodies, velocities
        self.control = step_doubling.allocate_control(spec, bodies, velocities, 3)
        self.cache = np.zeros(len(self.control.cache), self.control.cache.dtype)
        self.state = SimpleNamespace(
            **{"bodies": records(bodies), "velocities": records(velocities), "contacts": None},
            **{"cache": records(self.cache), "control": records(self.control)},
        )
        self.counters = memory.allocate_counters()
        self.rows = np.zeros(2, step_row_dtype(spec))
        self.record = records(self.control.record)[0]

    @property
    def counter(self) -> Any:
        return records(self.counters)[0]

    def begin(self) -> None:
        kernel = interpreted(step_doubling.make_begin_substep(self.spec))
        kernel(self.state, self.params, self.counter, records(self.rows))

    def end(self, failed: bool = False) -> int:
        kernel = interpreted(step_doubling.make_end_span(self.spec))
        arguments = self.params, records(self.counters), records(self.rows)
        return int(kernel(self.state, 0, *arguments, failed))

    def make(self, off: float = 0.0) -> int:
        """Make a substep whole and in halves, which are off by so much; return what comes next."""
        self.begin()
        self.velocities["vx"] = 1.0
        start = float(self.bodies["x"][0])
        length = float(self.record.length)
        self.bodies["x"] = start + length + off
        assert self.end() == GO_ON
        assert self.bodies["x"][0] == start
        for _ in range(2):
            self.bodies["x"] += 0.5 * length
            self.velocities["vx"] = 1.0
            said = self.end()
        return said


def test_a_substep_goes_to_the_end_or_as_far_as_proposed() -> None:
    for proposed, length in ((0.0, STEP), (0.2, STEP), (0.03, 0.03), (0.07, 0.05), (1e-9, 1e-3)):
        made = Substeps()
        made.record.proposed = proposed
        made.begin()
        assert (made.record.phase, made.record.length) == (WHOLE, pytest.approx(length))
        assert made.record.until == made.record.end == pytest.approx(length)
    late = Substeps()
    late.counter.parts, late.record.start, late.record.proposed = 1, 0.08, 0.05
    late.begin()
    assert (late.record.length, late.record.end) == (pytest.approx(0.02), STEP)
    # What is shorter than the shortest is made as it is.
    late.record.start, late.record.proposed = STEP - 5e-4, 1e-4
    late.begin()
    assert late.record.length == pytest.approx(5e-4)
    late.counter.parts = 0  # a new step
    late.begin()
    assert late.record.start == 0.0


def test_halves_follow_the_whole_from_the_same_start() -> None:
    made = Substeps()
    made.begin()
    spans = []
    for _ in range(3):
        spans.append((int(made.record.phase), float(made.record.until)))
        made.bodies["x"] += 0.1
        made.velocities["wz"] += 1.0
        said = made.end()
        if spans[-1][0] == WHOLE:
            assert (made.bodies["x"][0], made.velocities["wz"][0]) == (0.0, 0.0)
            assert made.control.whole["x"][0] == 0.1
            assert made.control.differences["wz"][0] == 1.0
            made.velocities["wz"] = -1.0  # halves that agree
            made.bodies["x"] = -0.1
    half, whole = 0.5 * STEP, STEP
    assert spans == [(WHOLE, whole), (FIRST_HALF, half), (SECOND_HALF, whole)]
    assert said == STEP_ENDS
    assert made.record.phase == NOTHING
    assert made.counter.elapsed == STEP


def test_every_part_of_a_whole_is_halved() -> None:
    """Where it ends at an impact or at a stop; one that is too short goes with what follows."""
    short = 0.9 * STEP / MOST_PARTS
    made, note = Substeps(), interpreted(step_doubling.make_note_part(SPEC))
    made.begin()
    for elapsed in (0.03, 0.03 + short, 0.07, 0.07):
        note(made.state.control, elapsed)
    spans = []
    while made.record.phase != NOTHING:
        assert made.end() in (GO_ON, STEP_ENDS)
        if made.record.phase != NOTHING:
            spans.append((int(made.record.phase), float(made.record.until)))
            note(made.state.control, 0.001)  # of halves nothing is noted
    middles = [(FIRST_HALF, pytest.approx(t)) for t in (0.015, 0.05, 0.085)]
    assert spans == [*middles, (SECOND_HALF, STEP)]
    assert made.counter.substeps == 2
    made.counter.parts = 0
    made.begin()  # the next has none
    assert made.end() == GO_ON
    assert made.record.until == 0.5 * STEP


def test_parts_that_are_halved_have_room() -> None:
    made, note = Substeps(), interpreted(step_doubling.make_note_part(SPEC))
    made.begin()
    for elapsed in np.linspace(0.0, STEP, 1000)[:-1]:
        note(made.state.control, elapsed)
    assert 8 <= made.record.cuts <= MOST_PARTS


def test_a_substep_ends_where_a_function_of_time_bends() -> None:
    spec = SPEC.including("varying_force")
    knots, drive = np.zeros(2, dtype(KNOT)), allocate_drives(spec, 1)
    knots["time"], drive["count"] = (0.0, 2.03), 2
    for begin, proposed, end in ((2.0, 0.0, 0.03), (2.0, 0.01, 0.01), (1.9, 0.0, STEP)):
        made = Substeps(spec, stretch_step=0, stretch_begin=begin)
        made.state.drives = SimpleNamespace(records=records(drive), knots=records(knots))
        made.record.proposed = proposed
        made.begin()
        assert made.record.end == made.record.until == pytest.approx(end, abs=1e-14)
        assert made.record.length == pytest.approx(end, abs=1e-14)
    made.record.start = made.counter.elapsed = 0.03  # behind it
    made.begin()
    assert made.record.end == STEP


def test_what_is_kept_is_counted_and_what_is_off_is_made_again() -> None:
    made = Substeps()
    assert made.make() == STEP_ENDS
    counter = made.counter
    assert (counter.substeps, counter.rejected, counter.shortest) == (2, 0, 0.5 * STEP)
    assert made.record.before == STEP
    assert made.control.paths["length"][0] == pytest.approx(STEP)
    made.counter.parts = 0
    x = float(made.bodies["x"][0])
    assert made.make(1e-3) == GO_ON
    assert (made.counter.substeps, made.counter.rejected) == (2, 1)
    assert made.bodies["x"][0] == x
    assert made.params.dt == STEP
    assert 0.0 < made.record.proposed <= 0.5 * STEP
    assert made.record.start == 0.0
    # A third of what halves and whole differ by, over the radius, and the speed to come.
    off = 2e-7
    made.counter.parts = 1
    made.record.proposed = 0.04
    assert made.make(off) == GO_ON
    assert made.record.start == pytest.approx(0.04)
    path = max(1.0, STEP + (DURATION - STEP - 0.04))
    error = off / path / 3.0
    assert made.counter.estimated_error == pytest.approx(error, rel=1e-6)
    assert made.counter.shortest == pytest.approx(0.02)
    assert made.record.spent == pytest.approx(error, rel=1e-3)


def test_a_run_that_no_substep_is_short_enough_for_ends() -> None:
    made = Substeps(smallest_timestep=STEP)
    assert made.make(1.0) == MISSED
    assert made.counter.body == 0
    assert made.record.proposed == STEP
    made = Substeps()
    made.counters["substeps"] = MOST_SUBSTEPS
    assert made.make() == MISSED
    made.counters["substeps"] = MOST_SUBSTEPS - 1
    made.counter.parts = 0
    assert made.make() == STEP_ENDS


def test_a_body_that_is_lost_takes_the_substep_back() -> None:
    for spans in (0, 1, 2):
        made = Substeps()
        made.begin()
        for _ in range(spans):
            made.end()
        made.bodies["x"] = np.nan
        assert made.end(failed=True) == GO_ON
        assert made.bodies["x"][0] == 0.0
        assert made.record.proposed == SHRINK * STEP
        assert made.counter.rejected == 1


def test_impressions_of_parts_are_gathered_over_the_halves() -> None:
    """Whether one was left without order; what it spent counts for its half alone."""
    for which in (FIRST_HALF, SECOND_HALF, 0):
        made = Substeps()
        made.begin()
        for phase in (WHOLE, FIRST_HALF, SECOND_HALF):
            assert made.record.phase == phase
            made.counter.unordered, made.counter.spent = int(phase == which), 9
            said = made.end()
            assert made.counter.spent == 0
        assert said == STEP_ENDS
        assert made.counter.unordered == int(which > 0)


def test_the_caller_may_begin_again() -> None:
    """All is as the substep began: bodies, impulses kept, counts and the row of the log."""
    made = Substeps()
    made.counters["cached"], made.cache["key"] = 2, [5, 6, 7]
    made.rows["contact_count"] = 3
    made.begin()
    made.bodies["x"], made.velocities["vx"], made.cache["key"] = 1.0, 2.0, 0
    made.counters["sweeps"], made.rows["contact_count"], made.params.dt = 7, 9, 0.01
    arguments = made.state, made.params, records(made.counters), records(made.rows)
    abandon = interpreted(step_doubling.make_abandon(SPEC))
    abandon(*arguments)
    assert (made.bodies["x"][0], made.velocities["vx"][0]) == (0.0, 0.0)
    assert made.cache["key"].tolist() == [5, 6, 0]  # of two rows in use
    assert (made.counters["sweeps"][0], made.rows["contact_count"].tolist()) == (0, [3, 9])
    assert (made.params.dt, made.record.phase) == (STEP, NOTHING)
    made.bodies["x"] = 4.0
    abandon(*arguments)  # nothing is being made
    assert made.bodies["x"][0] == 4.0


def test_who_woke_is_awake_when_the_substep_is_made_again() -> None:
    spec = SPEC.including("sleeping")
    for woke in (False, True):
        made = Substeps(spec)
        made.bodies["asleep"], made.bodies["inv_m"], made.bodies["rest"] = 1, 0.0, 3.0
        for name in ("inv_m", "inv_ix", "inv_iy", "inv_iz"):
            made.bodies[f"own_{name}"] = 2.0
        made.begin()
        made.bodies["asleep"] = int(not woke)
        restore = interpreted(step_doubling.make_restore(spec))
        restore(made.state, made.params, records(made.counters), records(made.rows))
        assert made.bodies["asleep"][0] == int(not woke)
        for name in ("inv_m", "inv_ix", "inv_iy", "inv_iz"):
            assert made.bodies[name][0] == 2.0 * woke
        assert made.bodies["rest"][0] == (0.0 if woke else 3.0)


def test_joints_that_stayed_together_are_known_to_when_the_substep_is_made_again() -> None:
    """The whole tears them, or finds them torn: neither half may take that for its own past."""
    spec = SPEC.including("joint", "contact_midpoint", "frictionless_contact", "compound")
    assert not step_doubling.keeps_unparted(SPEC)
    for stayed in (0, 1):
        made = Substeps(spec)
        motion = np.zeros(1, [("unparted", "i8")])
        made.state.motion = records(motion)
        motion["unparted"] = stayed
        made.begin()
        motion["unparted"] = 1 - stayed
        restore = interpreted(step_doubling.make_restore(spec))
        restore(made.state, made.params, records(made.counters), records(made.rows))
        assert motion["unparted"][0] == stayed


def test_memory_grows_with_contacts_where_impulses_are_kept() -> None:
    bodies, velocities = allocate_bodies(SPEC, 2), allocate_velocities(SPEC, 2)
    control = step_doubling.allocate_control(SPEC, bodies, velocities, 3)
    assert len(step_doubling.with_capacity(control, 8).cache) == 8
    cold = SPEC.without("warm_start", "step_log")
    control = step_doubling.allocate_control(cold, bodies, velocities, 3)
    assert step_doubling.with_capacity(control, 8) is control
    assert (len(control.cache), len(control.row)) == (0, 0)
    without = SPEC.without("error_control")
    assert step_doubling.allocate_control(without, bodies, velocities, 3) == ()
    assert step_doubling.with_capacity((), 8) == ()


def test_a_run_is_as_accurate_as_asked_and_substeps_go_with_the_root() -> None:
    """Of order 2 a fourth of the error takes twice the substeps; of a run of 1 s, over 0.1 s."""
    substeps = []
    for accuracy in (4e-5, 1e-5):
        steps = ball_on_ball("1/20", accuracy=accuracy)
        rows = steps.run(2)
        substeps.append(int(rows["substeps"].sum()))
        # Relative to the path: that so far, and its speed, below 1 m/s, for the rest of the run.
        assert abs(angle_of(steps) - pendulum(0.1)) * REACH <= accuracy
        assert rows["shortest"][1:].max() < 0.05
    assert substeps[1] / substeps[0] == pytest.approx(2.0, rel=0.3)


def test_a_run_that_cannot_be_as_accurate_says_so() -> None:
    steps = ball_on_ball("1/20", accuracy=1e-10, smallest_timestep=0.01)
    assert steps.advance(4) == DIVERGED
    assert steps.counters.cause == INACCURATE
