"""The estimate is Richardson's of order 2, and contacts take theirs from differences.

Halves of length h/2 of a method of order 2 end at x + E/4, the whole at x + E: they differ by 3/4
E, and a third of that is what the halves are off by.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drawn_contacts import Drawn, drawn, put_vector, random_frame, stacked, views
from interpreted import interpreted, records
from plain_facts import one_row

from lavendersim.engine import error_estimate
from lavendersim.engine.error_estimate import NOISE, PATH, PLACE_NOISE, RESPONDS, SWEEPS
from lavendersim.engine.record_layout import allocate_bodies, allocate_velocities
from lavendersim.engine.records import dtype
from lavendersim.engine.spec import Spec

# Rows that stick have a block of their tangents; compliant ones a gamma.
SPEC = Spec(
    effects=("compliance", "error_control", "friction", "rotation"),
    shape_pairs=("sphere_box", "sphere_sphere"),
)
FREE = SPEC._replace(shape_pairs=())
STILL = Spec(effects=("error_control",))
ESTIMATE = interpreted(error_estimate.make_estimate(FREE))
RESPECT = interpreted(error_estimate.make_respect_contacts(SPEC))
DURATION = 2.0


def quaternion(axis: np.ndarray, angle: float) -> np.ndarray:
    """Return the turn about an axis."""
    return np.array([np.cos(0.5 * angle), *(np.sin(0.5 * angle) * axis / np.linalg.norm(axis))])


class Pair:
    """Bodies after halves and after the whole, with paths and what is left of the run."""

    def __init__(self, count: int = 1, spec: Spec = FREE) -> None:
        self.bodies, self.velocities = (
            allocate_bodies(spec, count),
            allocate_velocities(spec, count),
        )
        self.bodies["inv_m"], self.bodies["bound"] = 1.0, 0.5
        if "qw" in self.bodies.dtype.names:
            self.bodies["qw"] = 1.0
        self.whole, self.other = self.bodies.copy(), self.velocities.copy()
        self.paths = np.zeros(count, dtype(PATH))

    def estimate(self, left: float = 0.0, residual: float = 0.0, kernel: Any = ESTIMATE) -> Any:
        control = SimpleNamespace(
            whole=records(self.whole),
            differences=records(self.other.copy()),
            paths=records(self.paths),
        )
        state = SimpleNamespace(
            bodies=records(self.bodies),
            velocities=records(self.velocities),
            contacts=None,
            control=control,
        )
        params = one_row(duration=DURATION, tolerance=1e-6)
        return kernel(state, 0, left, params, residual, True)


def test_it_is_richardsons_of_a_place() -> None:
    """A body whose path is L, whole off by E and halves by E/4: e = E/4/L."""
    pair, error, path = Pair(), 1e-3, 7.0
    pair.bodies["x"], pair.whole["x"] = 3.0 + 0.25 * error, 3.0 + error
    pair.paths["length"] = path
    found, floor, worst = pair.estimate()
    assert found == pytest.approx(0.25 * error / path, rel=1e-11)  # digits of 3 m left
    assert (floor, worst) == (pytest.approx(PLACE_NOISE / path / 3.0, rel=1e-15), 0)


def test_it_is_richardsons_of_a_turn(rng) -> None:
    """Its rim is off by R theta, of a chord to third order: theta^2/24 of it."""
    for _ in range(10):
        pair, angle = Pair(), 1e-3
        axis, start = rng.normal(size=3), quaternion(rng.normal(size=3), rng.uniform(0.0, 3.0))
        turn = quaternion(axis, angle)
        w, v = turn[0] * start[0] - turn[1:] @ start[1:], np.cross(turn[1:], start[1:])
        ended = [w, *(turn[0] * start[1:] + start[0] * turn[1:] + v)]
        for name, a, b in zip(("qw", "qx", "qy", "qz"), start, ended, strict=True):
            pair.bodies[name], pair.whole[name] = a, -b  # one turn has two quaternions
        pair.paths["length"] = 0.1  # R is more
        found, _, _ = pair.estimate()
        assert found == pytest.approx(angle / 3.0, rel=angle**2 / 12.0)


@pytest.mark.parametrize("turning", [False, True])
def test_it_is_richardsons_of_a_velocity_in_its_fastest(turning: bool, rng) -> None:
    """So far, now, or at least R in the run, whichever is most; R |w| counts like |v|."""
    pair, off = Pair(), 1e-4
    now, along = np.array([0.48, 0.6, 0.64]), random_frame(rng)[0]
    prefix, scale = ("w", 0.5) if turning else ("v", 1.0)
    put_vector(pair.velocities[0], "v", now)
    put_vector(pair.other[0], "v", now)
    put_vector(pair.other[0], prefix, off * along / scale + now * (not turning))
    for fastest, expected in ((0.2, 1.0), (3.0, 3.0)):
        pair.paths["fastest"] = fastest
        assert pair.estimate()[0] == pytest.approx(off / expected / 3.0, rel=1e-11)
    slow = Pair()
    put_vector(slow.other[0], prefix, off * along / scale)
    assert slow.estimate()[0] == pytest.approx(off / (0.5 / DURATION) / 3.0, rel=1e-11)


def test_a_spin_that_both_have_is_no_error(rng) -> None:
    """R |w_1 - w| of bodies that turn, about every axis; 0.5 m is R."""
    pair, off, spin = Pair(), 1e-4, rng.normal(size=3)
    along = random_frame(rng)[0]
    put_vector(pair.velocities[0], "w", spin)
    put_vector(pair.other[0], "w", spin + off * along / 0.5)
    pair.paths["fastest"] = 30.0
    # Of 1 rad/s the difference keeps digits to 1e-16.
    assert pair.estimate()[0] == pytest.approx(off / 30.0 / 3.0, rel=1e-10)


def test_what_is_left_of_the_run_goes_on_at_the_fastest() -> None:
    pair = Pair()
    pair.whole["y"], pair.paths["length"], pair.paths["fastest"] = 1e-3, 2.0, 5.0
    for left in (0.0, 0.7):
        found, floor, _ = pair.estimate(left)
        assert found == pytest.approx(1e-3 / (2.0 + 5.0 * left) / 3.0, rel=1e-14)
        assert floor == pytest.approx(PLACE_NOISE / (2.0 + 5.0 * left) / 3.0, rel=1e-14)


def test_the_worst_body_is_named_and_what_does_not_move_has_no_error() -> None:
    pair = Pair(4)
    pair.whole["x"] = [1.0, 1e-3, 3e-3, 2e-3]
    pair.bodies["inv_m"][0] = 0.0
    found, _, worst = pair.estimate()
    assert (worst, found) == (2, pytest.approx(3e-3 / 0.5 / 3.0))
    pair.bodies["inv_m"] = 0.0
    assert pair.estimate() == (0.0, 0.0, -1)


@pytest.mark.parametrize("field", ["x", "qy"])
def test_what_is_not_a_number_is_larger_than_anything(field: str) -> None:
    """And than all that follows: a finite error of the next body does not hide it."""
    pair = Pair(3)
    pair.whole[field][1], pair.whole["z"][[0, 2]] = np.nan, 1e6
    found, _, worst = pair.estimate()
    assert np.isnan(found)
    assert worst == 1


def test_solves_leave_no_error_of_the_timestep() -> None:
    """Below NOISE residuals, or tolerances where these are less, velocities say nothing."""
    pair = Pair()
    pair.velocities["vx"] = pair.other["vx"] = 2.0
    pair.whole["x"] = 1e-9
    for residual, least in ((1e-7, 1e-7), (1.0, 1e-6)):
        assert pair.estimate(0.0, residual)[1] == pytest.approx(NOISE * least / 2.0 / 3.0)


def test_bodies_that_do_not_turn_have_places_alone() -> None:
    pair = Pair(spec=STILL)
    pair.whole["z"], pair.other["vy"] = 3e-3, 1e-3
    kernel = interpreted(error_estimate.make_estimate(STILL))
    # U = R/T = 1/4 m/s.
    assert pair.estimate(kernel=kernel)[0] == pytest.approx(max(3e-3 / 0.5, 4e-3) / 3.0)


def test_paths_are_those_of_the_centre_and_of_the_rim() -> None:
    add_paths = interpreted(error_estimate.make_add_paths(FREE))
    pair = Pair(2)
    pair.bodies["inv_m"][0] = 0.0
    before = pair.bodies.copy()
    pair.bodies["x"], pair.bodies["z"] = 0.3, -0.4
    angle = 0.02
    pair.bodies["qw"], pair.bodies["qy"] = np.cos(0.5 * angle), np.sin(0.5 * angle)
    pair.velocities["vy"], pair.velocities["wz"] = -2.0, 3.0
    pair.paths["length"], pair.paths["fastest"] = 1.0, [0.0, 3.4]
    for speed in (3.5, 3.5):
        arguments = pair.bodies, pair.velocities, before, pair.paths
        add_paths(*(records(array) for array in arguments), 0.01)
        assert pair.paths["fastest"].tolist() == [0.0, speed]
    chord = 2.0 * np.sin(0.5 * angle)
    assert pair.paths["length"] == pytest.approx([1.0, 1.0 + 2.0 * (0.5 + 0.5 * chord)], rel=1e-12)


def sticking(scene: Drawn) -> np.ndarray:
    """Return rows of the Jacobian that hold: of what pushes, tangents of what sticks."""
    rows = []
    for k, contact in enumerate(scene.contacts):
        if contact["lambda_n"] > 0.0 and contact["gamma"] == 0.0:
            most = contact["mu"] * contact["lambda_n"]
            sticks = np.hypot(contact["lambda_1"], contact["lambda_2"]) < most * (1.0 - 1e-9)
            rows += [3 * k, 3 * k + 1, 3 * k + 2][: 3 if sticks else 1]
    return scene.jacobian[rows]


def pushing(scene: Drawn) -> np.ndarray:
    """Return rows along which these are held: what slides is pushed with its friction."""
    rows = []
    for k, contact in enumerate(scene.contacts):
        if contact["lambda_n"] > 0.0 and contact["gamma"] == 0.0:
            own = scene.jacobian[3 * k : 3 * k + 3]
            most = contact["mu"] * contact["lambda_n"]
            if np.hypot(contact["lambda_1"], contact["lambda_2"]) < most * (1.0 - 1e-9):
                rows += [*own]
                continue
            with_friction = (
                own[0]
                + (contact["lambda_1"] * own[1] + contact["lambda_2"] * own[2])
                / contact["lambda_n"]
            )
            response, plain = (own[0] @ scene.inverse @ row for row in (with_friction, own[0]))
            rows.append(with_friction if response > RESPONDS * plain else own[0])
    return np.array(rows)


def scene_of(rng: np.random.Generator, slides: bool) -> Drawn:
    """Return two free bodies and one that is fixed; a third contact is compliant, a fourth idle."""
    scene = drawn(SPEC, rng, [(0, 1), (1, 2), (2, 0), (2, 1)])
    scene.contacts["gamma"] = [0.0, 0.0, 0.3, 0.0]
    scene.contacts["lambda_n"][3] = 0.0
    if slides:
        contact = scene.contacts[0]
        size = np.hypot(contact["lambda_1"], contact["lambda_2"])
        for name in ("lambda_1", "lambda_2"):
            contact[name] *= contact["mu"] * contact["lambda_n"] / size
    return scene


@pytest.mark.parametrize("slides", [False, True])
def test_contacts_take_from_differences_what_is_across_them(slides: bool, rng) -> None:
    """What is left is J dv = 0 by impulses of contacts: along what holds, and against what slides.

    Where nothing slides that is the projection in the metric of the mass, the least change.
    """
    for _ in range(3):
        scene = scene_of(rng, slides)
        held, response = sticking(scene), scene.inverse @ pushing(scene).T
        impulses = np.linalg.solve(held @ response, held @ scene.motion)
        expected = scene.motion - response @ impulses
        _, velocities, contacts = views(scene)
        for _ in range(200):  # sweeps of SWEEPS, until nothing changes
            RESPECT(contacts, 4, velocities, 0.0)
            if abs(held @ stacked(scene.velocities)).max() < 1e-13:
                break
        np.testing.assert_allclose(stacked(scene.velocities), expected, atol=1e-10)


def test_sweeps_end_at_the_noise_or_at_their_limit(rng) -> None:
    scene = scene_of(rng, False)
    held, start = sticking(scene), scene.velocities.copy()
    _, velocities, contacts = views(scene)
    RESPECT(contacts, 4, velocities, np.inf)
    once = scene.velocities.copy()
    for _ in range(SWEEPS - 1):
        RESPECT(contacts, 4, velocities, np.inf)
    limit = scene.velocities.copy()
    for noise, expected in ((np.inf, once), (0.0, limit)):
        scene.velocities[:] = start
        RESPECT(contacts, 4, velocities, noise)
        assert scene.velocities.tobytes() == expected.tobytes()
    assert abs(held @ stacked(limit)).max() < abs(held @ stacked(once)).max()


@pytest.mark.parametrize("frictional", [0, 1])
def test_one_visit_of_a_contact_stops_its_slip_where_it_has_friction(frictional: int, rng) -> None:
    """Along both tangents at once, by the inverse of their block."""
    spec = SPEC.including("contact_torque", "frictionless_contact")
    respect = interpreted(error_estimate.make_respect_contacts(spec))
    scene = drawn(spec, rng, [(0, 1)], fixed=())
    scene.contacts["gamma"], scene.contacts["frictional"] = 0.0, frictional
    _, velocities, contacts = views(scene)
    respect(contacts, 1, velocities, np.inf)
    after = scene.jacobian @ scene.motion
    if frictional:
        assert after[1:] == pytest.approx([0.0, 0.0], abs=1e-13)
    else:
        assert after[0] == pytest.approx(0.0, abs=1e-13)
        assert np.hypot(*after[1:]) > 1e-3
