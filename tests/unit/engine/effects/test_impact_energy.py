"""Impacts that would gain energy leave by Stronge's law, and by less until nothing is gained."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import drawn, set_contact_velocity, stacked, views
from interpreted import interpreted, records
from plain_facts import facts, one_row, pair_facts

from lavendersim.engine.compile import inner
from lavendersim.engine.effects.impact_energy import EFFECT, make_note, make_settle, make_step_row
from lavendersim.engine.memory import allocate_counters
from lavendersim.engine.records import MOTION, dtype
from lavendersim.engine.solvers.solver import ContactSystem
from lavendersim.engine.spec import Spec
from lavendersim.engine.stronge import make_leave

SPEC = Spec(effects=("friction", "impact_energy", "impact_time", "restitution", "rotation"))
DT = 0.01


def at_once(contacts, count, motion, params):
    """Let every body meet as the step begins: no force acts before."""
    for i in range(len(motion)):
        motion[i].tau = 0.0


def make_scale(gain: float):
    """Return a solve whose impulses along the normal are what the target asks, times `gain`."""

    def solve(system, workspace, params, counters, rows):
        workspace[0] += 1
        for c in range(system.count):
            contact, v = system.contacts[c], system.velocities
            u = workspace[1][c]  # normal velocity before it
            contact.lambda_n = (-contact.target - u) / contact.k_n
            # What a friction would add that works on the bodies, whatever the slip.
            contact.lambda_1 = gain
            workspace[2](contact, v)

    return inner(solve)


class Meeting:
    """One contact of two free bodies that meet at 1 m/s, and slip."""

    def __init__(self, rng: np.random.Generator, e: float, spec: Spec = SPEC) -> None:
        self.spec, self.scene = spec, drawn(spec, rng, [(1, 2)], fixed=(0,))
        set_contact_velocity(self.scene, [-1.0, 0.4, 0.0])
        self.before = stacked(self.scene.velocities)
        row = self.scene.contacts
        row["v_n_pre"], row["e"], row["is_impact"], row["approach_speed"] = -1.0, e, 1, 1.0
        row["separation_speed"], row["target"], row["after"] = e, -e, 0.0
        row["lambda_2"] = 0.0
        _, velocities, contacts = views(self.scene)
        self.contact, self.velocities = contacts[0], velocities
        interpreted(make_note(spec))(self.contact, velocities[1], velocities[2])
        self.solves = 0

    def act(self, contact: Any, velocities: Any) -> None:
        """Give the bodies the velocities that the contact's impulses lead to, by dense algebra."""
        impulse = np.array([contact.lambda_n, contact.lambda_1, contact.lambda_2])
        v = self.before + self.scene.inverse @ self.scene.jacobian.T @ impulse
        for row, own in zip(self.scene.velocities, v.reshape(-1, 6), strict=True):
            for name, value in zip(("vx", "vy", "vz", "wx", "wy", "wz"), own, strict=True):
                row[name] = value

    @property
    def gained(self) -> float:
        """Change of kinetic energy since before the impact [J]."""
        now = stacked(self.scene.velocities)
        energy = [0.5 * v @ self.scene.mass @ v for v in (now, self.before)]
        return energy[0] - energy[1]

    def settle(self, friction: float) -> Any:
        """Solve once, and settle; friction: impulse along t1 [N s]."""
        solve = make_scale(friction)
        workspace = [0, [-1.0], self.act]
        bodies, _, contacts = views(self.scene)
        system = ContactSystem(contacts, np.arange(1), 1, bodies, self.velocities)
        counters = records(allocate_counters())[0]
        params = one_row(dt=DT, timestep=DT)
        solve.py_func(system, workspace, params, counters, None)
        self.first = self.gained
        motion = records(np.zeros(3, dtype(MOTION)))
        kernel = interpreted(make_settle(self.spec, solve, inner(at_once)))
        kernel(system, motion, workspace, params, counters, None)
        self.solves = workspace[0] - 1
        return counters


def test_the_slip_before_the_solve_is_noted(rng) -> None:
    meeting = Meeting(rng, 0.5)
    found = meeting.contact.pre_1, meeting.contact.pre_2
    np.testing.assert_allclose(found, [0.4, 0.0], atol=1e-13)


def test_what_gains_nothing_is_left_as_it_is(rng) -> None:
    meeting = Meeting(rng, 0.5)
    counters = meeting.settle(-0.01)
    assert meeting.first < 0.0
    assert (counters.stronge, meeting.solves) == (0, 0)
    assert meeting.contact.target == -0.5


def test_what_gains_leaves_as_fast_as_gains_nothing(rng) -> None:
    """A friction that drives: the largest separation speed at which the energy is not above."""
    meeting = Meeting(rng, 0.9)
    contact = meeting.contact
    slower, _ = interpreted(make_leave(SPEC))(contact, contact.pre_1, contact.pre_2)
    work = 0.5 * (1.0 - 0.9**2) / contact.k_n  # what the normal takes at e
    friction = 1.5 * work / 0.4
    counters = meeting.settle(friction)
    assert meeting.first > 0.0
    assert counters.stronge == 1
    assert 0.0 < -contact.target <= min(0.9, slower) + 1e-15
    # Stronge's law alone would gain, too: by halving nothing is gained, and nothing left.
    assert meeting.solves > 1
    assert meeting.gained == pytest.approx(0.0, abs=1e-11)


@pytest.mark.parametrize(("share", "solves"), [(2.0, False), (0.5, True)])
def test_a_damper_along_the_surface_takes_of_what_an_impact_gives(
    rng, share: float, solves: bool
) -> None:
    """1.2 of its speed is (1.2^2 - 1)/(2 K_n) more; a damper that takes twice that leaves it so.

    One that takes half has the impact settled. Of Euler's rule, with no impulse along the surface:
    s_1 - s_0 = -s_0/(1 + h), W = -h k_t (s_0/(1 + h))^2.
    """
    yields = ("compliance", "contact_spring", "contact_torque", "tangential_compliance")
    meeting = Meeting(rng, 1.2, SPEC.including(*yields, "warm_start"))
    contact, h, k = meeting.contact, 0.5, 1e4
    gained = 0.5 * (1.2**2 - 1.0) / contact.k_n
    contact.yield_k, contact.yield_dt, contact.yield_damping = k, DT, h
    contact.yield_1, contact.yield_2 = (1.0 + h) * np.sqrt(share * gained / (h * k)), 0.0
    counters = meeting.settle(0.0)
    assert (counters.stronge == 1, meeting.solves > 0) == (solves, solves)


def test_a_plastic_impact_has_nothing_to_give(rng) -> None:
    meeting = Meeting(rng, 0.0)
    counters = meeting.settle(5.0)
    assert meeting.first > 0.0
    assert (counters.stronge, meeting.solves) == (0, 0)


def test_a_step_says_whether_stronges_law_was_taken() -> None:
    row = one_row(stronge=0, stronge_not_converged=0)
    counters = one_row(stronge=1, stronge_not_converged=3)
    interpreted(make_step_row(SPEC))(row, None, counters)
    assert (row.stronge, row.stronge_not_converged) == (1, 3)


def test_it_is_on_where_something_bounces_and_something_has_friction() -> None:
    bounces = pair_facts("floor", "ball", restitution=0.5)
    frictional = pair_facts("floor", "box", friction=0.3)
    turns = pair_facts("floor", "box", rolling_friction=1e-3)
    for pairs, on in (((bounces,), False), ((frictional,), False), ((bounces, frictional), True),
                      ((bounces, turns), True)):  # fmt: skip
        assert EFFECT.decide(facts(pairs=pairs, impacts="at_surface")).on is on
    assert not EFFECT.decide(facts(pairs=(bounces, frictional))).on


@pytest.mark.parametrize("gives", [0.0, 0.6])
def test_the_guard_acts_where_bodies_gain_energy_and_only_there(gives, rng) -> None:
    """dE = lambda . w + 1/2 lambda . W lambda, whether or not rows ask for slip to be given back.

    Friction f gains where it reverses more slip than there was, and where it drives: beyond the
    two roots of that, which are looked at to a millionth.
    """
    spec = SPEC.including("tangential_restitution") if gives else SPEC
    e, slip = 0.9, 0.4
    first = Meeting(rng, e, spec)
    w = first.scene.jacobian @ first.scene.inverse @ first.scene.jacobian.T
    n = (1.0 + e) / w[0, 0]
    normal = -n + 0.5 * n * n * w[0, 0]
    roots = np.sort(np.roots([0.5 * w[1, 1], slip + n * w[0, 1], normal]))
    assert roots[0] < 0.0 < roots[1]
    for root in roots:
        for share in (1.0 - 1e-6, 1.0 + 1e-6):
            meeting = Meeting(np.random.default_rng(20250701), e, spec)
            if gives:
                row = meeting.scene.contacts
                row["reversed_1"] = row["surface_1"] = gives * slip
            counters = meeting.settle(share * root)
            assert (meeting.first > 0.0) == (share > 1.0)
            assert counters.stronge == int(share > 1.0)
