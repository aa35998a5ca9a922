"""Impacts of a step come in their order and at their times, by an event-driven twin.

Elastic balls fly without forces, so that the next impact of all pairs has a closed form:
    |c + v t| = r_a + r_b,   c, v: of B from A
The twin goes from one to the next; the kernel makes the parts of one step, from contacts at their
beginnings, and poses move by what it returns.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import pytest
from interpreted import interpreted, records
from laboratory import Bench, planned, resolved, sphere
from plain_facts import body_facts, facts, one_row, pair_facts

from lavendersim.engine.approach import FAR, OVERLAP
from lavendersim.engine.collide import narrow_phase
from lavendersim.engine.effects import impact_order
from lavendersim.engine.effects.impact_order import (
    CANDIDATES_A_ROW,
    EFFECT,
    ENDLESS,
    MOST_ROWS,
    REBOUND,
    make_order,
)

NUMERICS = {"impacts": "in_order", "speculative": True, "timestep": "1/10", "slop": 1e-5}
DT, RADIUS = 0.1, 0.1


class Meeting(NamedTuple):
    """An impact of the twin."""

    at: float  # [s]
    pair: tuple[int, int]


def bench_of(places: Any, velocities: Any, restitution: float = 1.0) -> Bench:
    """Return balls of 1 kg, elastic ones where nothing else is said."""
    balls = {
        f"ball {k}": sphere(RADIUS, place, velocity=tuple(v), restitution=restitution)
        for k, (place, v) in enumerate(zip(places, velocities, strict=True))
    }
    cell = resolved(balls, **NUMERICS)
    # Of many balls, too, all pairs are looked at.
    return Bench(cell, planned(cell).spec.without("broad_phase"))


class Step:
    """One step of an engine, whose parts are made with interpreted kernels."""

    def __init__(self, bench: Bench) -> None:
        engine = bench.engine
        self.arrays = engine.state
        self.state, self.workspace = records(engine.state), records(engine.workspace)
        self.counters, self.engine = records(engine.counters)[0], engine
        self.collide = interpreted(narrow_phase.make(bench.spec))
        self.order = interpreted(make_order(bench.spec))

    def part(self, left: float) -> tuple[int, float]:
        """Return how many rows the next part has and how long it is."""
        motion = self.arrays.motion
        for axis in "xyz":
            motion[f"v{axis}"] = self.arrays.velocities[f"v{axis}"]
        speeds = np.sqrt(sum(motion[f"v{axis}"] ** 2 for axis in "xyz"))
        motion["reach"] = speeds * left
        count = self.collide(self.state, len(self.arrays.pairs), self.workspace, left)
        params = one_row(dt=left, timestep=DT, slop=1e-5)
        return self.order(self.state, count, self.workspace, params, self.counters)

    def run(self) -> list[Meeting]:
        """Make the step; return its impacts."""
        found: list[Meeting] = []
        elapsed = 0.0
        while elapsed < DT:
            left = DT - elapsed
            self.counters.elapsed = elapsed
            count, length = self.part(left)
            assert self.counters.unordered == 0
            if length == 0.0:
                assert count == 1
                row = self.arrays.contacts[0]
                assert abs(row["phi"]) <= 1e-9
                bounce(self.arrays, int(row["a"]), int(row["b"]))
                found.append(Meeting(elapsed, tuple(sorted((int(row["a"]), int(row["b"]))))))
                continue
            for axis in "xyz":
                self.arrays.bodies[axis] += self.arrays.velocities[f"v{axis}"] * length
            elapsed = DT if length == left else elapsed + length
        return found


def places_of(arrays: Any) -> tuple[np.ndarray, np.ndarray]:
    x = np.column_stack([arrays.bodies[axis] for axis in "xyz"])
    v = np.column_stack([arrays.velocities[f"v{axis}"] for axis in "xyz"])
    return x, v


def bounce(arrays: Any, a: int, b: int) -> None:
    """Let two balls of one mass exchange their velocities along the line of their centres."""
    x, v = places_of(arrays)
    n = (x[b] - x[a]) / np.linalg.norm(x[b] - x[a])
    change = n * (n @ (v[b] - v[a]))
    for k, axis in enumerate("xyz"):
        arrays.velocities[f"v{axis}"][a] += change[k]
        arrays.velocities[f"v{axis}"][b] -= change[k]


def next_meeting(x: np.ndarray, v: np.ndarray, last: tuple[int, int] | None) -> Meeting:
    """Return the next of all pairs; those that just met part."""
    best = Meeting(np.inf, (-1, -1))
    for a in range(len(x)):
        for b in range(a + 1, len(x)):
            c, w = x[b] - x[a], v[b] - v[a]
            along, squared = c @ w, w @ w
            under = along**2 - squared * (c @ c - 4.0 * RADIUS**2)
            if (a, b) != last and along < 0.0 and under > 0.0:
                best = min(best, Meeting((-along - np.sqrt(under)) / squared, (a, b)))
    return best


def twin(places: Any, velocities: Any) -> tuple[list[Meeting], np.ndarray]:
    """Return the impacts within DT, and where the balls are then."""
    x, v = np.array(places, float), np.array(velocities, float)
    now, found, last = 0.0, [], None
    while True:
        coming = next_meeting(x, v, last)
        step = min(coming.at, DT - now)
        x, now = x + v * step, now + step
        if coming.at > step:
            return found, x
        a, b = last = coming.pair
        n = (x[b] - x[a]) / np.linalg.norm(x[b] - x[a])
        change = n * (n @ (v[b] - v[a]))
        v[a], v[b] = v[a] + change, v[b] - change
        found.append(Meeting(now, last))


def compared(places: Any, velocities: Any) -> int:
    """Compare kernel and twin; return how many impacts there are."""
    bench = bench_of(places, velocities)
    found, (expected, ends) = Step(bench).run(), twin(places, velocities)
    assert [meeting.pair for meeting in found] == [meeting.pair for meeting in expected]
    # They are met to 1e-9/4 m, at tens of m/s; each impact makes what is off some ten times more.
    for one, other in zip(found, expected, strict=True):
        assert one.at == pytest.approx(other.at, abs=1e-8)
    np.testing.assert_allclose(places_of(bench.engine.state)[0], ends, atol=1e-6)
    return len(found)


def test_balls_in_a_row_meet_one_after_the_other() -> None:
    """One comes with 10 m/s and hands its velocity on, over gaps of 1, 2 and 3 cm."""
    places = [(x, 0.0, 0.0) for x in (0.0, 0.21, 0.43, 0.66)]
    velocities = [(10.0, 0.0, 0.0)] + [(0.0, 0.0, 0.0)] * 3
    bench = bench_of(places, velocities)
    found = Step(bench).run()
    assert [meeting.pair for meeting in found] == [(0, 1), (1, 2), (2, 3)]
    assert [meeting.at for meeting in found] == pytest.approx([1e-3, 3e-3, 6e-3], abs=1e-9)
    x, v = places_of(bench.engine.state)
    assert v[:, 0].tolist() == [0.0, 0.0, 0.0, 10.0]
    assert x[:, 0] == pytest.approx([0.01, 0.23, 0.46, 0.66 + 10.0 * 0.094], abs=1e-8)
    assert compared(places, velocities) == 3


def test_a_cloud_of_balls_meets_as_the_twins_does(rng) -> None:
    """In three dimensions, with impacts beside each other: of all pairs the next is the next."""
    impacts = 0
    for _ in range(5):
        grid = np.indices((2, 2, 2)).reshape(3, -1).T * 0.26
        places = grid + rng.uniform(-0.02, 0.02, grid.shape)
        impacts += compared(places, rng.normal(size=grid.shape) * 2.0)
    assert impacts > 15


def test_what_no_part_of_the_step_reaches_is_far_and_what_rests_has_no_order() -> None:
    still = Step(bench_of([(0, 0, 0), (0.2, 0, 0), (0.9, 0, 0)], [(0.0, 0.0, 0.0)] * 3))
    assert still.part(DT) == (1, DT)
    assert still.counters.spent == 0
    state = still.arrays
    state.velocities["vx"][2] = 1.0  # at most 0.1 m in the step
    assert still.part(DT) == (1, DT)
    state.bodies["x"][2] = 0.4 + 0.05
    assert still.part(DT)[1] == DT  # it parts
    params = one_row(dt=DT, timestep=DT, slop=1e-5)
    for reaches, far in (((0.0, 0.0), True), ((0.02, 0.0), False), ((0.0, 0.02), False)):
        state.contacts["located"], state.contacts["phi"][0] = 0, 0.01
        state.motion["reach"][:2] = reaches
        still.order(still.state, 1, still.workspace, params, still.counters)
        assert (state.contacts["located"][0] == FAR) == far


def test_what_overlaps_leaves_the_step_without_order() -> None:
    for depth, unordered in ((1.01 * OVERLAP, 1), (0.99 * OVERLAP, 0)):
        places = [(0.0, 0.0, 0.0), (0.2 - depth, 0.0, 0.0)]
        step = Step(bench_of(places, [(1.0, 0.0, 0.0), (0.0, 0.0, 0.0)]))
        count, length = step.part(DT)
        assert (count, step.counters.unordered) == (1, unordered)
        assert length == (DT if unordered else 0.0)


def row_of_balls(count: int, others: int = 0) -> Step:
    """Return balls in a row that touch, and one that has come to the first; other pairs rest."""
    places = [(0.2 * k, 0.0, 0.0) for k in range(count)]
    places += [(0.2 * (k % 2), 1.0 + k // 2, 0.0) for k in range(2 * others)]
    return Step(bench_of(places, [(0.1, 0.0, 0.0)] + [(0.0, 0.0, 0.0)] * (len(places) - 1)))


@pytest.mark.parametrize(("balls", "unordered"), [(MOST_ROWS + 1, 0), (MOST_ROWS + 2, 1)])
def test_an_impact_of_a_crowd_is_not_made_by_itself(balls: int, unordered: int) -> None:
    step = row_of_balls(balls)
    count, length = step.part(DT)
    assert (count, step.counters.unordered) == (balls - 1, unordered)
    assert length == (DT if unordered else 0.0)
    rows = balls - 1
    assert step.counters.spent == 1 + rows + rows // CANDIDATES_A_ROW


def test_a_step_spends_its_work_and_goes_on_without_order() -> None:
    """Balls that rebound have more of it, most where few touch; there what goes on is plastic."""
    rows = 3
    for others, most in ((0, ENDLESS), (MOST_ROWS - rows + 1, REBOUND)):
        own = 1 + rows + (rows + others) // CANDIDATES_A_ROW
        for before, unordered in ((most - own, 0), (most - own + 1, 1)):
            step = row_of_balls(rows + 1, others)
            step.counters.spent = before
            step.part(DT)
            counters = step.counters
            assert (counters.spent, counters.unordered) == (before + own, unordered)
            assert counters.plastic == (unordered if others == 0 else 0)


def test_the_part_behind_a_meeting_knows_which_it_was() -> None:
    """The two that met, and when: that they meet now is no news to what foresees impacts."""
    step = Step(bench_of([(0, 0, 0), (0.21, 0, 0)], [(10.0, 0, 0), (0, 0, 0)]))
    step.counters.elapsed = 0.02
    _, length = step.part(DT - 0.02)
    counters = step.counters
    assert (counters.met_a, counters.met_b) == (0, 1)
    assert counters.met_at == 0.02 + length == pytest.approx(0.021, abs=1e-9)


@pytest.mark.parametrize(
    ("met", "at", "meets"),
    [((0, 1), 0.02, True), ((0, 1), 0.01, False), ((0, 2), 0.02, False), ((2, 1), 0.02, False)],
)
def test_a_slow_meeting_is_an_impact_of_the_two_that_met_and_then(met, at, meets) -> None:
    """Plastic, and slower than forces of now may change it: of others it is a lasting contact."""
    places, velocities = [(0, 0, 0), (0.2, 0, 0), (5, 0, 0)], [(0.1, 0, 0), (0, 0, 0), (0, 0, 0)]
    step = Step(bench_of(places, velocities, 0.0))
    step.arrays.motion["dvx"] = 5.0
    step.counters.elapsed = 0.02
    (step.counters.met_a, step.counters.met_b), step.counters.met_at = met, at
    _, length = step.part(DT - 0.02)
    assert length == (0.0 if meets else DT - 0.02)


def floor_and_ball(**properties: float) -> Any:
    bodies = body_facts("floor", "plane", movable=False), body_facts("ball", "sphere")
    pair = pair_facts("floor", "ball", **properties)._replace(shape_pair="sphere_plane")
    return facts(*bodies, pairs=(pair,), impacts="in_order", pair_count=1)


def test_it_is_on_where_impacts_may_follow_each_other() -> None:
    one = floor_and_ball()
    assert not EFFECT.decide(one).on
    assert EFFECT.decide(one._replace(pair_count=2)).on
    assert EFFECT.decide(floor_and_ball(compliance=1e-4)).on
    assert EFFECT.decide(floor_and_ball(friction=0.1, tangential_restitution=0.1)).on
    assert not EFFECT.decide(floor_and_ball(friction=0.0, tangential_restitution=0.1)).on
    two = one._replace(pair_count=2)
    for other in ({"impacts": "captured"}, {"pairs": ()}, {"stabilisation_gain": 0.1}):
        decision = EFFECT.decide(two._replace(**other))
        assert not decision.on, decision.reason


def test_a_motor_asks_for_no_parts_where_a_gain_pushes_by_the_step(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A target of gain / length times depth grows without bound as a part gets short."""
    monkeypatch.setattr("lavendersim.engine.effects.impact_order.driving", lambda _: ["rod, base"])
    driven = floor_and_ball()
    assert EFFECT.decide(driven).on
    assert not EFFECT.decide(driven._replace(stabilisation_gain=0.02, pair_count=2)).on


@pytest.mark.parametrize("down", [(0.0, 0.0, -9.81), (0.0, 0.6, -0.8)])
def test_a_ball_that_may_slide_back_on_its_plane_has_parts(down: tuple[float, ...]) -> None:
    """Gravity along the normal drives nothing along the plane, in whatever direction that is."""
    for bodies, slides in ((one_plane((0.0, 0.0, 1.0)), down[1] != 0.0), (one_plane(down), False)):
        known = bodies._replace(gravity=down, integrator="midpoint_contact")
        assert impact_order.slides_back(known) == slides
        later = known._replace(gravity=(0.0, 0.0, 0.0), later_gravity=(down,))
        assert impact_order.slides_back(later) == slides
        assert not impact_order.slides_back(known._replace(integrator="midpoint"))
        pulled = known.bodies[1]._replace(force=True)
        assert impact_order.slides_back(known._replace(bodies=(known.bodies[0], pulled)))
    assert not impact_order.slides_back(known._replace(pairs=floor_and_ball().pairs))


def one_plane(normal: tuple[float, ...]) -> Any:
    known = floor_and_ball(friction=0.5)
    length = float(np.linalg.norm(normal))
    shape = SimpleNamespace(normal=tuple(x / length for x in normal))
    floor = known.bodies[0]._replace(config=SimpleNamespace(shape=shape))
    return known._replace(bodies=(floor, known.bodies[1]))


def test_the_log_has_the_parts_of_the_step() -> None:
    row = one_row(parts=0, unordered=0, impact_not_converged=0)
    kernel = interpreted(impact_order.make_step_row(bench_of([(0, 0, 0)], [(0, 0, 0)]).spec))
    kernel(row, None, one_row(parts=3, unordered=1, impact_not_converged=2))
    assert (row.parts, row.unordered, row.impact_not_converged) == (3, 1, 2)
