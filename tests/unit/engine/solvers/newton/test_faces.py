"""What a contact does tells its face, and impulses on it answer as Coulomb's law leaves them to."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import drawn, set_contact_velocity, views
from interpreted import interpreted

from lavendersim.engine.solvers.newton import faces, response
from lavendersim.engine.solvers.newton.faces import OPEN, SLIDES, STICKS
from lavendersim.engine.spec import Spec

FRICTIONAL = Spec(effects=("friction", "least_norm", "newton", "rotation"), solver="adaptive")
FRICTIONLESS = Spec(
    effects=("contact_torque", "least_norm", "newton", "rotation"), solver="adaptive"
)
STILL = 1e-6


def one_contact(rng, w=(0.0, 0.0, 0.0), spec=FRICTIONAL, **fields: float):
    """Return a contact at the velocity w, target included, and its scene."""
    scene = drawn(spec, rng, [(1, 2)], fixed=(0,))
    set_contact_velocity(scene, np.array(w) - [scene.contacts["target"][0], 0.0, 0.0])
    for name, value in fields.items():
        scene.contacts[name] = value
    return scene, views(scene)


@pytest.mark.parametrize(
    ("w", "impulse", "face"),
    [
        ((0.3, 0.0, 0.0), 0.0, OPEN),
        ((0.5 * STILL, 0.0, 0.0), 0.0, STICKS),  # as slow as a solve leaves what rests
        ((2.0 * STILL, 0.0, 0.0), 0.0, OPEN),
        ((0.3, 0.0, 0.0), 1.0, STICKS),  # it presses: closed, by as much as the solve is off
        ((0.0, 0.5 * STILL, -0.5 * STILL), 1.0, STICKS),
        ((0.0, 0.9 * STILL, -0.9 * STILL), 1.0, SLIDES),
        ((0.0, -0.3, 0.4), 1.0, SLIDES),
    ],
)
def test_a_face_is_known_by_velocity_and_impulse(w, impulse, face, rng) -> None:
    _, (_, velocities, contacts) = one_contact(rng, w, lambda_n=impulse)
    contact = contacts[0]
    interpreted(faces.make_find_face(FRICTIONAL))(contact, velocities[1], velocities[2], STILL)
    assert contact.face == face
    assert contact.start_n == impulse
    assert (contact.start_1, contact.start_2) == (contact.lambda_1, contact.lambda_2)
    if face == SLIDES:
        np.testing.assert_allclose((contact.slip_1, contact.slip_2), w[1:], atol=1e-14)
        assert (contact.given_1, contact.given_2) == (contact.lambda_1, contact.lambda_2)


def test_without_friction_nothing_slides(rng) -> None:
    find = interpreted(faces.make_find_face(FRICTIONLESS))
    for w_n, impulse, face in ((0.3, 0.0, OPEN), (0.0, 0.0, STICKS), (0.3, 1.0, STICKS)):
        _, (_, velocities, contacts) = one_contact(
            rng, (w_n, 0.3, 0.0), FRICTIONLESS, lambda_n=impulse
        )
        find(contacts[0], velocities[1], velocities[2], STILL)
        assert contacts[0].face == face


WAY = {
    "scale": 0.8, "stiff_n": 2.0, "stiff_t": 3.0, "start_n": 1.0, "start_1": 0.2, "start_2": -0.1,
    "velocity_n": 0.1, "velocity_1": 0.3, "velocity_2": -0.2, "step_n": 0.05, "step_1": 0.1,
    "mu": 0.4, "given_1": 0.11, "given_2": -0.07,
}  # fmt: skip


def test_impulses_and_stiffness_are_those_of_the_face(rng) -> None:
    """Open: nothing. Stuck: nearest in the cone. Sliding: its normal gives way, friction stays."""
    impulse = interpreted(faces.make_face_impulse(FRICTIONAL))
    stiffness = interpreted(faces.make_face_stiffness(FRICTIONAL))
    _, (_, _, contacts) = one_contact(rng, **WAY)
    contact = contacts[0]
    contact.face = OPEN
    assert impulse(contact, 0.5) == (0.0, 0.0, 0.0)
    assert stiffness(contact) == (0.0,) * 6
    contact.face = STICKS
    nearest = interpreted(response.make_projected_impulse(FRICTIONAL))
    assert impulse(contact, 0.5) == nearest(contact, 0.5)
    assert stiffness(contact) == interpreted(response.make_stiffness(FRICTIONAL))(contact)
    contact.face = SLIDES
    n = 0.8 * 1.0 - 2.0 * (0.1 + 0.5 * 0.05)
    assert impulse(contact, 0.5) == (pytest.approx(n, rel=1e-15), 0.11, -0.07)
    assert stiffness(contact) == (2.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    contact.velocity_n = 1.0
    assert impulse(contact, 0.0) == (0.0, 0.11, -0.07)
    assert stiffness(contact) == (0.0,) * 6


def test_open_ones_without_friction_have_nothing_either(rng) -> None:
    impulse = interpreted(faces.make_face_impulse(FRICTIONLESS))
    stiffness = interpreted(faces.make_face_stiffness(FRICTIONLESS))
    _, (_, _, contacts) = one_contact(rng, **WAY)
    for face, n, nn in ((OPEN, 0.0, 0.0), (STICKS, 0.6, 2.0)):
        contacts[0].face = face
        assert impulse(contacts[0], 0.0) == (pytest.approx(n, rel=1e-15), 0.0, 0.0)
        assert stiffness(contacts[0]) == (nn, 0.0, 0.0, 0.0, 0.0, 0.0)


def test_friction_of_what_slides_turns_against_its_slip(rng) -> None:
    """mu lambda_n against slip and what has changed of it; the change is the larger component's."""
    turn = interpreted(faces.make_turn_friction(FRICTIONAL))
    _, (_, _, contacts) = one_contact(rng, **WAY, slip_1=0.3, slip_2=1.0)
    contact = contacts[0]
    contact.face = STICKS
    assert turn(contact) == 0.0
    assert contact.given_1 == 0.11
    contact.face = SLIDES
    slip = np.array([0.3 + 0.3, 1.0 - 0.2])  # of length 1
    expected = -0.4 * (0.8 - 0.2) * slip
    change = turn(contact)
    np.testing.assert_allclose((contact.given_1, contact.given_2), expected, rtol=1e-14)
    assert change == pytest.approx(np.abs(expected - [0.11, -0.07]).max(), rel=1e-14)
    assert faces.make_turn_friction(FRICTIONLESS) is None
