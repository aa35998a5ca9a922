"""Contacts at the middle of the step: no work, no drift, order 2.

A ball on a fixed ball is a pendulum upside down. With the normal of the middle the mean velocity is
along the surface there, and a circle's chord is across the normal at its middle: the ball stays on
the circle to round-off, and energy is kept, for of uniform gravity the mean force is its gradient.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from ball_on_ball import GRAVITY, RADIUS, REACH, SPEED, angle_of, ball_on_ball, pendulum
from drawn_contacts import put_vector
from interpreted import interpreted
from interpreted_steps import Steps
from laboratory import sphere

from lavendersim.engine import midpoint_passes
from lavendersim.engine.compile import chain
from lavendersim.engine.contact import make_append_contact
from lavendersim.engine.effects import made_by
from lavendersim.engine.integrate import MIDDLE, UNFOUND
from lavendersim.engine.midpoint_passes import MOST_PASSES, PASSES, make_go_back, make_stand_up


@pytest.mark.parametrize("friction", [0.0, 0.9])
def test_energy_and_the_circle_are_kept(friction: float) -> None:
    """Rolling, too: what sticks slips by nothing in the mean."""
    steps = ball_on_ball(friction=friction)
    rows = steps.run(20)
    energy = rows["kinetic_energy"] + rows["potential_energy"]
    assert rows["midpoint_not_converged"].tolist() == [0] * 20
    assert np.linalg.norm(steps.places[1]) == pytest.approx(REACH, abs=1e-10)
    # What a pass may miss, 1e-9 m/s, times 1 m/s.
    np.testing.assert_allclose(energy, energy[0], atol=2e-9)
    assert angle_of(steps) > 0.25


def test_it_is_of_second_order() -> None:
    """A quarter of the error at half the timestep; the rest is of the next even order."""
    expected, errors = pendulum(0.16), []
    for timestep, count in (("1/50", 8), ("1/100", 16), ("1/200", 32)):
        steps = ball_on_ball(timestep)
        steps.run(count)
        errors.append(abs(angle_of(steps) - expected))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.05)
    assert errors[0] < 1e-3


@pytest.mark.parametrize("friction", [0.0, 0.9])
def test_a_ball_that_lifts_off_flies_from_the_start_of_its_step(friction: float) -> None:
    """At v^2 > g R on the top no contact holds it: a parabola, to the last digits."""
    steps = ball_on_ball(speed=3.0, friction=friction)
    steps.run(5)
    t = 0.05
    expected = (3.0 * t, 0.0, REACH - 0.5 * GRAVITY * t * t)
    np.testing.assert_allclose(steps.places[1], expected, atol=1e-12)


def test_a_spring_elsewhere_leaves_passes_as_they_are() -> None:
    """Energy and the circle are kept, of the ball on a ball and of two balls that swing."""
    cell = ball_on_ball().bench.cell
    for name, x in (("one", 3.0), ("other", 3.5)):
        cell["scene"]["bodies"][name] = sphere(0.1, (x, 0.0, 0.0), velocity=(0.0, 0.5, 0.0))
    cell["scene"]["springs"] = [{"a": "one", "b": "other", "stiffness": 50.0, "rest_length": 0.4}]
    steps = Steps(cell)
    assert steps.spec.has("spring")
    rows = steps.run(12)
    energy = rows["kinetic_energy"] + rows["potential_energy"] + rows["spring_energy"]
    assert rows["midpoint_not_converged"].tolist() == [0] * 12
    assert np.linalg.norm(steps.places[1]) == pytest.approx(REACH, abs=1e-10)
    np.testing.assert_allclose(energy, energy[0], atol=2e-9)


class Passes:
    """The kernel after a solve at the start, with a solver by hand."""

    def __init__(
        self,
        solve: Any,
        speed: float = SPEED,
        impact: int = 0,
        share: float = 1.0,
        **counters: float,
    ) -> None:
        """share: of the step, what its part is long."""
        self.steps = ball_on_ball()
        engine, spec = self.steps.engine, self.steps.spec
        self.state, self.workspace, self.log, parameters, _ = self.steps.arrays()
        self.arrays, self.parameters = engine.state, parameters[0]
        self.parameters.timestep, self.parameters.dt = 0.01, 0.01 * share
        motion, velocities = engine.state.motion, engine.state.velocities
        put_vector(motion[1], "v", (speed, 0.0, 0.0))
        self.fall = -GRAVITY * 0.01 * share
        put_vector(motion[1], "dv", (0.0, 0.0, self.fall))
        put_vector(velocities[1], "v", (speed, 0.0, self.fall))
        engine.workspace.middle.free[:] = velocities
        append = make_append_contact(spec, chain(made_by(spec, "capture"), spec))
        contact = engine.state.contacts[0]
        contact["a"], contact["b"], contact["nz"], contact["z"] = 0, 1, 1.0, RADIUS
        interpreted(append)(
            *(self.state.contacts[0], self.state.bodies, self.state.velocities, self.state.motion),
            *(self.state.pairs[0], self.parameters),
        )
        self.contact = self.state.contacts[0]
        self.contact.lambda_n = self.impulse = -self.fall
        velocities["vz"][1] = 0.0
        self.contact.lasts, self.contact.is_impact = 1, impact
        self.counters = self.steps.counters
        for name, value in counters.items():
            self.counters[name] = value
        self.calls = 0

        def counted(system: Any, workspace: Any, params: Any, tally: Any, rows: Any) -> None:
            self.calls += 1
            solve(self, system, tally)

        make = midpoint_passes.make_midpoint_passes(spec, append, None, counted)
        self.before = engine.bodies.copy()
        self.passed = bool(
            interpreted(make)(
                *(self.state, 1, self.workspace, self.parameters, self.counters, self.log)
            )
        )


def push(passes: Passes, system: Any, counters: Any) -> None:
    """Solve the one row, whatever it had."""
    row, v = system.contacts[0], system.velocities[1]
    v_n = row.nx * v.vx + row.ny * v.vy + row.nz * v.vz
    change = max(-(v_n + row.target) * row.inv_k, -row.lambda_n)
    row.lambda_n += change
    v.vx, v.vy, v.vz = v.vx + row.nx * change, v.vy + row.ny * change, v.vz + row.nz * change
    counters.not_converged, counters.sweeps = 0, 1


def test_passes_end_where_the_middle_stays() -> None:
    passes = Passes(push, sweeps=3)
    assert passes.passed
    assert passes.counters.midpoint_not_converged == 0
    assert 2 <= passes.calls < PASSES
    assert passes.counters.sweeps == 3 + passes.calls
    motion = passes.arrays.motion
    assert motion["midway"].tolist() == [MIDDLE, MIDDLE]
    # Bodies are left at the middle, for what looks at them there.
    assert passes.arrays.bodies["x"][1] == pytest.approx(0.5 * 0.01 * 0.8, rel=1e-3)
    assert passes.workspace.middle.poses.array.tobytes() == passes.before.tobytes()
    interpreted(make_stand_up(passes.steps.spec))(
        passes.state.bodies, passes.workspace.middle.poses
    )
    assert passes.arrays.bodies.tobytes() == passes.before.tobytes()


def test_a_brief_part_has_a_middle() -> None:
    """Whatever the cache has, which brief parts leave as it is: passes meet their own solution."""
    passes = Passes(push, speed=SPEED, share=1e-5, cached=1, cached_dt=0.01)
    assert passes.passed
    assert passes.counters.midpoint_not_converged == 0
    # Along the circle of the middle: v^2 / r below the weight, half a part on.
    pressed = (GRAVITY - SPEED * SPEED / REACH) * 0.01 * 1e-5
    assert passes.contact.lambda_n == pytest.approx(pressed, rel=1e-4)


def test_a_middle_that_is_never_found_is_counted() -> None:
    """Each solve leads elsewhere: passes end, and what is solved at the start counts."""

    def wanders(passes: Passes, system: Any, counters: Any) -> None:
        push(passes, system, counters)
        system.velocities[1].vx += 0.1 * ((7 * passes.calls * passes.calls) % 11 - 5)

    passes = Passes(wanders)
    assert PASSES < passes.calls <= MOST_PASSES + 1
    assert not passes.passed
    assert passes.arrays.motion["midway"].tolist() == [UNFOUND, UNFOUND]
    assert passes.counters.midpoint_not_converged == 1
    assert passes.arrays.bodies.tobytes() == passes.before.tobytes()


def test_a_middle_that_is_not_solved_gives_way_to_the_start() -> None:
    """Bodies, velocities and impulses are those of the start, solved once more."""

    def fails(passes: Passes, system: Any, counters: Any) -> None:
        if passes.calls > PASSES:
            # The last solve begins with what the one at the start ended with.
            row, v = system.contacts[0], system.velocities[1]
            assert (row.nx, row.nz, row.x, row.z) == (0.0, 1.0, 0.0, RADIUS)
            assert row.lambda_n == passes.impulse
            assert (v.vx, v.vz) == (0.8, 0.0)
        counters.sweeps, counters.not_converged = 10, int(passes.calls <= PASSES)

    passes = Passes(fails, sweeps=5)
    assert passes.calls == PASSES + 1
    assert not passes.passed
    assert passes.counters.sweeps == 5 + 10 * passes.calls
    assert passes.counters.midpoint_not_converged == 1
    assert passes.arrays.bodies.tobytes() == passes.before.tobytes()


def nothing(passes: Passes, system: Any, counters: Any) -> None:
    raise AssertionError("there is no middle")


def test_what_is_not_solved_at_the_start_has_no_middle() -> None:
    passes = Passes(nothing, not_converged=1)
    assert not passes.passed
    assert passes.arrays.bodies.tobytes() == passes.before.tobytes()


def test_an_impact_has_none_either() -> None:
    passes = Passes(nothing, impact=1)
    assert not passes.passed
    assert passes.arrays.bodies.tobytes() == passes.before.tobytes()


def test_what_goes_nowhere_has_that_of_the_start() -> None:
    assert not Passes(nothing, speed=0.0).passed


def test_contacts_go_back_with_their_bodies_to_where_the_step_begins() -> None:
    """For what is solved there once more, as beside springs: the normal, and where the ball is."""
    passes = Passes(push)
    contact = passes.contact
    assert passes.passed
    assert contact.x == pytest.approx(0.5 * 0.01 * 0.8 * RADIUS / REACH, rel=1e-2)
    assert contact.nx > 1e-3
    state, poses = passes.state, passes.workspace.middle.poses
    interpreted(make_go_back(passes.steps.spec))(state, 1, poses)
    assert passes.arrays.bodies.tobytes() == passes.before.tobytes()
    assert (contact.nx, contact.nz, contact.x, contact.z) == (0.0, 1.0, 0.0, RADIUS)
