"""Contacts respond as their laws say: what is solved, logged, kept for the next step and moved."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from interpreted import interpreted, records
from interpreted_steps import Steps
from laboratory import box, plane, resolved, sphere

from lavendersim.engine import memory
from lavendersim.engine.respond import make_pass_by, make_respond, make_solve
from lavendersim.engine.spec import Spec

GRAVITY, STEP, RADIUS = 10.0, 0.01, 0.1
NUMERICS: dict[str, Any] = {"timestep": STEP, "tolerance": 1e-12, "sweeps": 500}


def pile(count: int, height: float = 0.0, **numerics: Any) -> Steps:
    """Return balls of 1 kg on each other on a floor, from a height."""
    bodies: dict[str, Any] = {"floor": plane()}
    for k in range(count):
        bodies[f"ball {k}"] = sphere(RADIUS, (0.0, 0.0, height + (2 * k + 1) * RADIUS))
    return Steps(resolved(bodies, (0.0, 0.0, -GRAVITY), **{**NUMERICS, **numerics}))


def test_contacts_of_a_pile_carry_what_is_above_them() -> None:
    """From the top m g dt, twice that, and so on; nothing moves, and the log has it."""
    steps = pile(4)
    steps.advance(1)
    rows = steps.engine.take_rows()
    weights = np.array([4.0, 3.0, 2.0, 1.0]) * GRAVITY * STEP
    np.testing.assert_allclose(rows.contact["impulse_n"], weights, atol=1e-10)
    np.testing.assert_allclose(rows.contact["force_n"], weights / STEP, atol=1e-8)
    np.testing.assert_allclose(rows.contact["approach_velocity"], [-0.1, 0, 0, 0], atol=1e-15)
    np.testing.assert_allclose(steps.velocities, 0.0, atol=1e-11)
    assert rows.step["total_normal_force"][-1] == pytest.approx(weights.sum() / STEP)
    assert not rows.step["not_converged"].any()


def test_the_next_step_begins_with_the_impulses_of_this_one() -> None:
    """Warm, a pile at rest is solved as it begins; cold, it takes its sweeps again."""
    for warm in (True, False):
        steps = pile(4, warm_start=warm)
        first, second = (int(steps.run(1)["sweeps"][0]) for _ in range(2))
        assert steps.counters.cached == (4 if warm else 0)
        assert (second < first / 4) == warm
    assert first == second


def test_what_is_not_solved_in_its_sweeps_is_said() -> None:
    rows = pile(6, sweeps=3).run(1)
    assert rows["not_converged"].tolist() == [1]
    assert rows["sweeps"].tolist() == [3]
    assert rows["residual"][0] > 1e-12


def test_what_penetrates_is_moved_out_without_velocity() -> None:
    """A share of what is beyond the slop, by pseudo-velocities: poses move, velocities do not."""
    depth, slop, share = 1e-3, 1e-4, 0.2
    steps = pile(1, -depth, projection=share, slop=slop, projection_sweeps=50)
    steps.run(1)
    moved = steps.places[1, 2] - (RADIUS - depth)
    assert moved == pytest.approx(share * (depth - slop), rel=1e-9)
    np.testing.assert_allclose(steps.velocities, 0.0, atol=1e-12)
    assert steps.counters.projection_sweeps > 0
    still = pile(1, -depth, projection=0.0, slop=slop)
    still.run(1)
    assert still.places[1, 2] == pytest.approx(RADIUS - depth, abs=1e-15)


@pytest.mark.parametrize("friction", [0.0, 0.1, 2.0])
def test_a_box_that_slides_stops_by_its_friction(friction: float) -> None:
    """Of velocity v friction takes mu g dt, or all of it; against the motion, within the cone."""
    bodies = {
        "floor": plane(friction=friction),
        "box": box((0.4, 0.4, 0.02), (0.0, 0.0, 0.01), friction=friction, velocity=(0.06, 0.08, 0)),
    }
    steps = Steps(resolved(bodies, (0.0, 0.0, -GRAVITY), **NUMERICS))
    steps.advance(1)
    rows = steps.engine.take_rows()
    left = max(0.1 - friction * GRAVITY * STEP, 0.0)
    # The box is thin: its levers tip it by less than mu h/l, some hundredths.
    np.testing.assert_allclose(steps.velocities[1, :2], (0.6 * left, 0.8 * left), atol=1e-10)
    assert rows.contact["impulse_n"].sum() == pytest.approx(GRAVITY * STEP, abs=1e-10)
    if friction:
        tangential = np.hypot(rows.contact["impulse_t1"], rows.contact["impulse_t2"])
        assert (tangential <= friction * rows.contact["impulse_n"] + 1e-12).all()


def test_bodies_that_meet_keep_their_momentum_and_rebound_by_their_coefficient() -> None:
    for order in (1, -1):
        bodies = {
            "left": sphere(RADIUS, (0.0, 0, 0), mass=1.0, velocity=(2.0, 0, 0), restitution=0.5),
            "right": sphere(RADIUS, (0.2, 0, 0), mass=3.0, velocity=(-1.0, 0, 0), restitution=0.5),
        }
        steps = Steps(resolved(dict(list(bodies.items())[::order]), **NUMERICS))
        steps.run(1)
        left, right = steps.velocities[::order, 0]
        assert left + 3.0 * right == pytest.approx(-1.0, abs=1e-12)
        assert right - left == pytest.approx(0.5 * 3.0, abs=1e-12)


def test_a_step_without_contacts_leaves_none_of_the_counts_of_one_with_them() -> None:
    spec = pile(1).spec
    counters = memory.allocate_counters()
    names = ("sweeps", "projection_sweeps", "residual", "not_converged", "stronge", "cached")
    for name in (*names, "sharpen", "contact_energy"):
        counters[name] = 1
    counters["residual_contact"] = 4

    def log_contacts(contacts: Any, count: int, *others: Any) -> None:
        calls.append(count)

    calls: list[int] = []
    kernel = interpreted(make_pass_by(spec, log_contacts))
    kernel(None, None, None, None, records(counters)[0], None)
    assert [counters[name][0] for name in (*names, "sharpen", "contact_energy")] == [0] * 8
    assert counters["residual_contact"][0] == -1
    assert calls == [0]


def test_impulses_that_laws_leave_open_are_chosen_where_the_solve_converged() -> None:
    """Four feet of a table share its weight alike: that has the least norm of all that carry it.

    A solve that begins with more across one diagonal, which carries it as well, leaves that.
    """
    for undetermined, even in (("least_norm", True), ("as_solved", False)):
        bodies = {"floor": plane(), "box": box((0.4, 0.3, 0.1), (0.0, 0.0, 0.05))}
        numerics = {**NUMERICS, "solver": "adaptive", "undetermined_forces": undetermined}
        steps = Steps(resolved(bodies, (0.0, 0.0, -GRAVITY), **numerics))
        assert steps.spec.has("least_norm") == even
        steps.run(1)
        cache = steps.engine.state.cache[:4]
        cache["lambda_n"] += 0.01 * np.sign(cache["rx"] * cache["ry"])
        steps.engine.counters["unchosen"] = 1.0  # as sweeps had changed them [m/s]
        steps.advance(1)
        shares = steps.engine.take_rows().contact["impulse_n"]
        assert shares.sum() == pytest.approx(GRAVITY * STEP, abs=1e-10)
        assert (np.ptp(shares) < 1e-10) == even


def test_a_solver_alone_is_what_is_composed_where_nothing_is_chosen() -> None:
    names = [
        make_solve(Spec(effects=effects)).py_func.__name__ for effects in ((), ("least_norm",))
    ]
    assert names[0] != names[1] == "solve_and_choose"


class Response:
    """The kernel called by hand for what the step found."""

    def __init__(self, length: float) -> None:
        self.steps = pile(2, speculative=True, impacts="in_order", integrator="midpoint_contact")
        spec = self.steps.spec
        self.logged: list[int] = []

        def log_contacts(contacts: Any, count: int, *others: Any) -> None:
            self.logged.append(count)

        engine = self.steps.engine
        state, workspace, log, parameters, counters = self.steps.arrays()
        engine.velocities["vz"][1], engine.state.motion["vz"][1] = -1.0, -1.0
        contact = engine.state.contacts[0]
        contact["b"], contact["nz"] = 1, 1.0
        self.parameters = parameters[0]
        self.parameters.timestep, self.parameters.dt = STEP, length
        kernel = interpreted(make_respond(spec, log_contacts))
        arguments = state, 1, workspace, self.parameters, counters[0], log
        self.length = float(kernel(*arguments))
        self.contact, self.counters = state.contacts[0], counters[0]


def test_an_instant_is_an_impact_and_leaves_no_guess_for_forces() -> None:
    """Its impulse is m v, in no time; a part of some length keeps what it ended with."""
    for length, cached in ((1e-12, 0), (0.5 * STEP, 1)):
        response = Response(length)
        assert response.length == 0.0
        assert response.contact.lambda_n == pytest.approx(1.0, rel=1e-12)
        assert response.steps.velocities[1, 2] == pytest.approx(0.0, abs=1e-12)
        assert response.counters.cached == cached
        assert response.logged == [1]
        if cached:
            assert response.contact.is_impact == 0
            assert response.contact.tau == length
