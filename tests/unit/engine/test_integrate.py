"""Bodies move as free flight, contacts and impacts at their times move them, in closed form.

Under a constant force a body that flies is at x + v t + a t^2/2: up to an impact from the velocity
before, from there on to the velocity after, which has the whole of what the force gives.
"""

from __future__ import annotations

from typing import Any

import convex
import numpy as np
import pytest
from drawn_contacts import put_vector, random_frame
from interpreted import interpreted, records
from plain_facts import one_row
from scipy.spatial.transform import Rotation

from lavendersim.engine import integrate
from lavendersim.engine.integrate import AFTERWARDS, AHEAD, ALWAYS, IMPACT, LASTING, UNFOUND
from lavendersim.engine.record_layout import allocate_bodies, allocate_velocities, contact_dtype
from lavendersim.engine.records import (
    MOTION,
    NOT_FINITE,
    TURNS_TOO_FAST,
    dtype,
)
from lavendersim.engine.rotation import orient
from lavendersim.engine.spec import Spec

DT = 0.02
PLAIN = Spec()
TURNS = Spec(effects=("rotation",))
MIDPOINT = Spec(effects=("midpoint", "rotation"))
UNEVEN = Spec(effects=("gyroscopic", "midpoint", "rotation"))
IN_TIME = Spec(effects=("gyroscopic", "impact_time", "midpoint", "rotation"))
CENTRED = IN_TIME.including("contact_midpoint")
ORIENT = interpreted(orient)


class Body:
    """A body of spec, by vectors."""

    def __init__(self, spec: Spec, rng: np.random.Generator, moments: Any = (1, 1, 1)) -> None:
        self.rows, self.velocities = allocate_bodies(spec, 1), allocate_velocities(spec, 1)
        self.motion = np.zeros(1, dtype(MOTION))
        self.row, self.v, self.m = (
            records(a)[0] for a in (self.rows, self.velocities, self.motion)
        )
        self.rows["inv_m"], self.rows["bound"], self.motion["tau"] = 0.5, 0.3, DT
        self.moments, self.turns = np.array(moments, float), spec.has("rotation")
        put_vector(self.rows[0], "", rng.normal(size=3))
        if self.turns:
            q = rng.normal(size=4)
            for name, value in zip(("qw", "qx", "qy", "qz"), q / np.linalg.norm(q), strict=True):
                self.rows[name] = value
            put_vector(self.rows[0], "inv_i", 1.0 / self.moments)
            ORIENT(self.row)
        self.start, self.frame = self.place(), self.turn()

    def gives(self, **vectors: Any) -> Body:
        """Set vectors of velocity, `v` and `w`, and of motion, `m` before the field."""
        for name, vector in vectors.items():
            of_motion = name.startswith("m_")
            row = self.motion[0] if of_motion else self.velocities[0]
            put_vector(row, name.removeprefix("m_"), vector)
        return self

    def place(self) -> np.ndarray:
        return np.array([self.rows[axis][0] for axis in "xyz"])

    def turn(self) -> np.ndarray:
        if not self.turns:
            return np.eye(3)
        return convex.matrix_of(np.array([self.rows[q][0] for q in ("qw", "qx", "qy", "qz")]))

    def spin(self) -> np.ndarray:
        return np.array([self.velocities[f"w{axis}"][0] for axis in "xyz"])

    def inertia(self) -> np.ndarray:
        return self.turn() @ np.diag(self.moments) @ self.turn().T

    def moved(self, spec: Spec) -> np.ndarray:
        """Displace it; return by how much."""
        assert interpreted(integrate.make_displace(spec))(self.row, self.v, self.m, DT)
        return self.place() - self.start

    def angle(self) -> np.ndarray:
        """Return the turn that it made by Cayley's map, as 2 tan(angle/2) about its axis."""
        turned = self.turn() @ self.frame.T
        skew = (turned - turned.T) / (1.0 + np.trace(turned))
        return 2.0 * np.array([skew[2, 1], skew[0, 2], skew[1, 0]])


@pytest.mark.parametrize("midpoint", [False, True])
def test_what_flies_moves_by_its_mean_velocity_or_by_the_last(midpoint: bool, rng) -> None:
    spec = MIDPOINT if midpoint else TURNS
    v, a = rng.normal(size=(2, 3))
    body = Body(spec, rng).gives(m_v=v, v=v + a * DT, m_dv=a * DT)
    expected = v * DT + (0.5 if midpoint else 1.0) * a * DT**2
    np.testing.assert_allclose(body.moved(spec), expected, atol=1e-15)


def test_what_a_contact_carries_moves_by_the_velocity_that_respects_it(rng) -> None:
    v, after, dv = rng.normal(size=(3, 3))
    body = Body(MIDPOINT, rng).gives(m_v=v, v=after, m_dv=dv)
    body.motion["carried"] = ALWAYS
    np.testing.assert_allclose(body.moved(MIDPOINT), after * DT, atol=1e-15)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.9])
@pytest.mark.parametrize("carried", [0, AFTERWARDS, ALWAYS])
def test_an_impact_parts_the_flight_where_it_is(carried: int, share: float, rng) -> None:
    """Rebounding it flies on; what stays on a surface keeps its velocity from there."""
    v, a, after = rng.normal(size=(3, 3))
    tau = share * DT
    body = Body(IN_TIME, rng).gives(m_v=v, v=after, m_dv=a * DT)
    body.motion["carried"], body.motion["tau"] = carried, tau
    rest = DT - tau
    expected = v * tau + after * rest
    if carried != ALWAYS:
        expected += 0.5 * a * tau**2
    if carried == 0:
        expected -= 0.5 * a * rest**2  # `after` is the velocity at the end
    np.testing.assert_allclose(body.moved(IN_TIME), expected, atol=1e-15)


@pytest.mark.parametrize("moments", [(1.0, 1.0, 1.0), (0.5, 1.0, 1.3)])
def test_a_spin_jumps_at_the_impact(moments: tuple[float, ...], rng) -> None:
    """It turns with the spin before, then with that after; about a principal axis these add up."""
    body = Body(IN_TIME, rng, moments)
    axis, (before, after), tau = body.frame[:, 1], (2.0, -3.0), 0.25 * DT
    body.gives(m_w=before * axis, w=after * axis)
    body.motion["tau"] = tau
    body.moved(IN_TIME)
    turned = 2.0 * np.arctan(0.5 * before * tau) + 2.0 * np.arctan(0.5 * after * (DT - tau))
    np.testing.assert_allclose(body.angle(), 2.0 * np.tan(0.5 * turned) * axis, atol=1e-14)
    np.testing.assert_allclose(body.spin(), after * axis, atol=1e-14)


def test_an_impact_as_the_step_begins_turns_with_the_spin_after(rng) -> None:
    body = Body(IN_TIME, rng).gives(m_w=(5.0, 5.0, 5.0), w=(0.0, 1.0, 0.0))
    body.motion["tau"] = 0.0
    body.moved(IN_TIME)
    np.testing.assert_allclose(body.angle(), (0.0, DT, 0.0), atol=1e-15)


def test_what_lasts_moves_and_turns_by_the_mean_of_both_ends(rng) -> None:
    v, after, w, spin = rng.normal(size=(4, 3))
    body = Body(CENTRED, rng).gives(m_v=v, v=after, m_w=w, w=spin)
    body.motion["carried"] = LASTING
    np.testing.assert_allclose(body.moved(CENTRED), 0.5 * DT * (v + after), atol=1e-15)
    np.testing.assert_allclose(body.angle(), 0.5 * DT * (w + spin), atol=1e-14)


@pytest.mark.parametrize("carried", [LASTING, ALWAYS])
def test_an_uneven_body_turns_as_its_contacts_at_the_middle_reckon(carried: int, rng) -> None:
    """By the mean of both ends' spins, or of what jumps by the last, as it moves.

    The spin at the end of what jumps is the mean's other side, in axes of the body: 2 w_m - w_0.
    Of what lasts the world's momentum has grown by 2 I (w - w_m), of the middle of its turn.
    """
    v, after, w, spin, mean = rng.normal(size=(5, 3))
    body = Body(CENTRED, rng, (0.5, 1.0, 1.3)).gives(m_v=v, v=after, m_w=w, w=spin, m_mean_=mean)
    body.motion["carried"], body.motion["midway"] = carried, 1
    lasts, momentum = carried == LASTING, body.inertia() @ w
    moved = DT * (0.5 * (v + after) if lasts else after)
    np.testing.assert_allclose(body.moved(CENTRED), moved, atol=1e-15)
    np.testing.assert_allclose(body.angle(), DT * (mean if lasts else spin), atol=1e-14)
    if lasts:
        turned = Rotation.from_matrix(body.turn() @ body.frame.T) ** 0.5
        half = turned.as_matrix() @ body.frame
        momentum = momentum + 2.0 * half @ np.diag(body.moments) @ half.T @ (spin - mean)
        np.testing.assert_allclose(body.inertia() @ body.spin(), momentum, atol=1e-13)
    else:
        expected = body.turn() @ body.frame.T @ (2.0 * mean - w)
        np.testing.assert_allclose(body.spin(), expected, atol=1e-13)


@pytest.mark.parametrize("carried", [0, LASTING])
def test_a_torque_gives_its_momentum_to_an_uneven_body_that_turns(carried: int, rng) -> None:
    """Half of it before the turn, half after: momentum of the world's frame adds up exactly."""
    spec = CENTRED if carried else UNEVEN
    for _ in range(5):
        body = Body(spec, rng, (0.5, 1.0, 1.3))
        w, gained = rng.normal(size=(2, 3))
        momentum = body.inertia() @ (w + gained)
        body.gives(m_w=w, w=w + gained, m_v=(0, 0, 0), v=(0, 0, 0))
        body.motion["carried"] = carried
        body.moved(spec)
        # The middle of the turn is found to 1e-14 of it.
        np.testing.assert_allclose(body.inertia() @ body.spin(), momentum, atol=1e-12)


def test_where_no_middle_is_found_an_uneven_body_wins_no_energy_by_its_turn(rng) -> None:
    """It has its whole spin before the turn, which keeps energy; halves would not."""
    for midway, changes in ((UNFOUND, 1e-12), (0, np.inf)):
        body = Body(CENTRED, rng, (0.5, 1.0, 1.3))
        w, spin = rng.normal(size=(2, 3)) + np.array([[5.0], [8.0]])
        body.gives(m_w=w, w=spin, m_v=(0, 0, 0), v=(0, 0, 0))
        body.motion["carried"], body.motion["midway"] = LASTING, midway
        energy = spin @ body.inertia() @ spin
        body.moved(CENTRED)
        change = abs(body.spin() @ body.inertia() @ body.spin() / energy - 1.0)
        assert change <= changes
        assert midway == UNFOUND or change > 1e-6


def test_halves_of_a_torque_are_of_second_order(rng) -> None:
    """A round body that is driven about its axis turns by the mean spin of the step."""
    body = Body(UNEVEN, rng).gives(m_w=(0, 0, 3.0), w=(0, 0, 4.0))
    body.moved(UNEVEN)
    np.testing.assert_allclose(body.angle(), (0.0, 0.0, 3.5 * DT), atol=1e-14)
    np.testing.assert_allclose(body.spin(), (0.0, 0.0, 4.0), atol=1e-14)


def test_forces_are_noted_and_undone(rng) -> None:
    """`begin` keeps the velocity, what forces add to it, and how far any point may get."""
    spec = MIDPOINT
    body = Body(spec, rng)
    v, w, dv, dw = rng.normal(size=(4, 3))

    def accelerate(row: Any, velocity: Any, params: Any) -> None:
        velocity.vx, velocity.vy, velocity.vz = v + dv
        velocity.wx, velocity.wy, velocity.wz = w + dw

    body.gives(v=v, w=w)
    begin = integrate.make_begin(spec, accelerate)
    arrays = records(body.rows), records(body.velocities), records(body.motion)
    interpreted(begin)(*arrays, one_row(dt=DT))
    for prefix, expected in (("v", v), ("w", w), ("dv", dv)):
        found = [body.motion[f"{prefix}{axis}"][0] for axis in "xyz"]
        np.testing.assert_allclose(found, expected, atol=1e-15)
    reach = DT * (np.linalg.norm(v + dv) + 0.3 * np.linalg.norm(w + dw))
    assert body.motion["reach"][0] == pytest.approx(reach, rel=1e-14)
    body.gives(v=v + 3.0 * dv)
    interpreted(integrate.make_finish(spec))(*arrays, one_row(dt=DT))
    found = [body.motion[f"dv{axis}"][0] for axis in "xyz"]
    np.testing.assert_allclose(found, 3.0 * dv, atol=1e-15)
    interpreted(integrate.make_undo(spec))(*arrays[1:])
    np.testing.assert_array_equal(body.spin(), w)
    assert [body.velocities[f"v{axis}"][0] for axis in "xyz"] == v.tolist()
    interpreted(integrate.make_stand(spec))(*arrays[1:])
    assert [body.motion[f"dv{axis}"][0] for axis in "xyz"] == [0.0] * 3


def test_what_is_fixed_feels_no_force_and_reaches_nowhere(rng) -> None:
    body = Body(MIDPOINT, rng).gives(v=(1.0, 0.0, 0.0))
    body.rows["inv_m"], body.motion["reach"] = 0.0, 7.0

    def accelerate(row: Any, velocity: Any, params: Any) -> None:
        raise AssertionError("a force on what is fixed")

    arrays = records(body.rows), records(body.velocities), records(body.motion)
    interpreted(integrate.make_begin(MIDPOINT, accelerate))(*arrays, one_row(dt=DT))
    assert body.motion["reach"][0] == 0.0


FLOOR = 0
CLASSIFY = interpreted(integrate.make_classify(CENTRED))


def classified(rows: list[dict[str, Any]], bodies: int = 4) -> list[tuple[int, float]]:
    """Return how each body is carried, and to when it flies, in steps."""
    contacts = np.zeros(len(rows), contact_dtype(CENTRED))
    for contact, row in zip(contacts, rows, strict=True):
        contact["lambda_n"], contact["separation_speed"] = 1.0, 1.0
        for name, value in row.items():
            contact[name] = value
        contact["inv_m_a"], contact["inv_m_b"] = (float(contact[s] != FLOOR) for s in "ab")
    motion = np.zeros(bodies, dtype(MOTION))
    motion["carried"], motion["tau"] = 77, 77.0
    CLASSIFY(records(contacts), len(rows), records(motion), one_row(dt=DT))
    return [(int(m["carried"]), float(m["tau"] / DT)) for m in motion]


LASTS = {"a": FLOOR, "b": 1, "lasts": 1}
MET = {"a": FLOOR, "b": 1, "is_impact": IMPACT, "tau": 0.25 * DT}


def test_contacts_that_do_not_push_leave_bodies_free() -> None:
    for row in (LASTS, MET, {"a": FLOOR, "b": 1}):
        assert classified([row | {"lambda_n": 0.0}]) == [(0, 1.0)] * 4


def test_a_contact_lasts_carries_or_is_an_impact() -> None:
    assert classified([LASTS])[1] == (LASTING, 1.0)
    assert classified([{"a": FLOOR, "b": 1}])[1] == (ALWAYS, 1.0)
    assert classified([MET])[1] == (0, 0.25)
    assert classified([MET | {"separation_speed": 0.0}])[1] == (AFTERWARDS, 0.25)


def test_the_first_impact_of_a_body_counts_and_one_that_stays_is_carried() -> None:
    later = MET | {"tau": 0.5 * DT, "separation_speed": 0.0}
    for rows in ([MET, later], [later, MET]):
        assert classified(rows)[1] == (AFTERWARDS, 0.25)
        assert classified([*rows, LASTS])[1] == (AFTERWARDS, 0.25)
    carried = {"a": FLOOR, "b": 1}
    for rows in ([MET, carried], [carried, MET], [carried, later]):
        flipped = [row | {"a": 1, "b": FLOOR} for row in rows]
        assert classified(rows)[1][0] == classified(flipped)[1][0] == ALWAYS
    assert classified([MET, LASTS])[1] == (0, 0.25)


def test_a_gap_that_is_reached_at_the_end_carries_what_has_had_no_impact() -> None:
    ahead = {"a": 1, "b": 2, "is_impact": AHEAD}
    assert [c for c, _ in classified([ahead])] == [0, ALWAYS, ALWAYS, 0]
    assert [c for c, _ in classified([MET, ahead])] == [0, 0, ALWAYS, 0]


def test_what_a_body_that_jumps_pushes_jumps_with_it() -> None:
    """From contact to contact in any order, but over no floor."""
    chain = [
        {"a": 2, "b": 3, "lasts": 1},
        {"a": 1, "b": 2, "lasts": 1},
        {"a": FLOOR, "b": 1},
        {"a": FLOOR, "b": 4, "lasts": 1},
        {"a": 5, "b": 6, "lasts": 1},
    ]
    expected = [ALWAYS, ALWAYS, ALWAYS, LASTING, LASTING, LASTING]
    for rows in (chain, chain[::-1]):
        assert [c for c, _ in classified(rows, 7)][1:] == expected
    flipped = [row | {"a": row["b"], "b": row["a"]} for row in chain]
    assert [c for c, _ in classified(flipped, 7)][1:] == expected


def moved_all(spec: Spec, body: Body, pseudo: Any = None, moved: bool = False) -> tuple[int, int]:
    arrays = (body.rows, body.velocities, body.motion, pseudo)
    kernel = interpreted(integrate.make_integrate(spec))
    return kernel(*(records(array) for array in arrays), moved, DT)


@pytest.mark.parametrize("spec", [PLAIN, TURNS, UNEVEN])
def test_positions_go_with_velocities(spec: Spec, rng) -> None:
    body = Body(spec, rng).gives(v=(1.0, 2.0, 3.0), m_v=(1.0, 2.0, 3.0))
    if spec is not PLAIN:
        body.gives(w=(0.0, 0.0, 2.0), m_w=(0.0, 0.0, 2.0))
    assert moved_all(spec, body) == (-1, NOT_FINITE)
    np.testing.assert_allclose(body.place() - body.start, DT * np.array([1, 2, 3]), atol=1e-15)
    if spec is not PLAIN:
        np.testing.assert_allclose(body.angle(), (0.0, 0.0, 2.0 * DT), atol=1e-14)


def test_what_is_fixed_stays_and_what_is_kinematic_moves(rng) -> None:
    for kinematic in (0, 1):
        spec = TURNS.including("kinematic")
        body = Body(spec, rng).gives(v=(1.0, 0.0, 0.0), w=(0.0, 1.0, 0.0))
        body.rows["inv_m"], body.rows["kinematic"] = 0.0, kinematic
        assert moved_all(spec, body) == (-1, NOT_FINITE)
        assert (body.place() != body.start).any() == bool(kinematic)
        assert (body.turn() != body.frame).any() == bool(kinematic)


def test_pseudo_velocities_move_and_turn_where_there_are_any(rng) -> None:
    spec = TURNS.including("contact_torque", "projection")
    pseudo = allocate_velocities(spec, 1)
    put_vector(pseudo[0], "v", (0.1, 0.2, 0.3))
    put_vector(pseudo[0], "w", (0.0, 0.01, 0.0))
    for moved in (False, True):
        body = Body(spec, rng)
        assert moved_all(spec, body, pseudo, moved) == (-1, NOT_FINITE)
        shift = body.place() - body.start
        np.testing.assert_allclose(shift, moved * np.array([0.1, 0.2, 0.3]), atol=1e-15)
        np.testing.assert_allclose(body.angle(), (0.0, 0.01 * moved, 0.0), atol=1e-14)


@pytest.mark.parametrize(("field", "value"), [("vx", np.nan), ("vz", 1e200), ("wy", np.inf)])
def test_a_state_that_is_not_finite_is_named(field: str, value: float, rng) -> None:
    """A speed whose square overflows has no energy."""
    body = Body(TURNS, rng)
    body.velocities[field] = value
    with np.errstate(all="ignore"):
        assert moved_all(TURNS, body) == (0, NOT_FINITE)


def test_a_turn_without_solution_is_named(rng) -> None:
    """Of bodies that turn by tens of radians in the step Newton's method loses some."""
    spec, causes = Spec(effects=("gyroscopic", "rotation")), []
    for _ in range(30):
        body = Body(spec, rng, (0.01, 1.0, 1.005))
        body.gives(w=3e3 * random_frame(rng)[0])
        causes.append(moved_all(spec, body))
    assert set(causes) == {(-1, NOT_FINITE), (0, TURNS_TOO_FAST)}


def test_velocities_before_are_kept_where_an_effect_needs_them() -> None:
    for name in ("midpoint", "impact_time", "contact_midpoint", "speculative"):
        assert integrate.keeps_motion(Spec(effects=(name,)))
    assert not integrate.keeps_motion(TURNS)
