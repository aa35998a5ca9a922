"""A projected impulse is the nearest of Coulomb's cone in the metric 1/e, and E' its derivative.

Nearest: lambda in K, w = (lambda - x)/e in the dual cone mu |w_t| <= w_n, lambda . w = 0.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from drawn_contacts import drawn, views
from interpreted import Row, interpreted

from lavendersim.engine.solvers.newton import response
from lavendersim.engine.solvers.newton.envelope import DOF, OF_A, OF_B
from lavendersim.engine.spec import Spec

FRICTIONAL = Spec(effects=("friction", "newton", "rotation"), solver="adaptive")
COMPLIANT = FRICTIONAL.including("compliance", "surface_velocity")
FRICTIONLESS = Spec(effects=("contact_torque", "newton", "rotation"), solver="adaptive")
PAIRS = [(0, 1), (1, 2), (2, 0), (2, 1)]


def any_contact(rng: np.random.Generator) -> Iterator[Row]:
    """Yield contacts around impulses, on their way through velocities of any kind."""
    for _ in range(30):
        _, _, contacts = views(drawn(FRICTIONAL, rng, [(0, 1)]))
        contact = contacts[0]
        contact.scale, contact.stiff_n, contact.stiff_t = rng.uniform(0.3, 2.0, 3)
        for name in ("start", "velocity", "step"):
            for axis in "n12":
                setattr(contact, f"{name}_{axis}", rng.normal())
        yield contact


def asked_for(contact: Row, length: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Return x = s lambda^k - e w, and e."""
    e = np.array([contact.stiff_n, contact.stiff_t, contact.stiff_t])
    start, velocity, step = (
        np.array([contact[f"{name}_{axis}"] for axis in "n12"])
        for name in ("start", "velocity", "step")
    )
    return np.array([contact.scale, 1.0, 1.0]) * start - e * (velocity + length * step), e


def test_impulses_are_the_nearest_of_the_cone(rng) -> None:
    project = interpreted(response.make_projected_impulse(FRICTIONAL))
    kinds = set()
    for contact in any_contact(rng):
        impulse, (x, e), mu = np.array(project(contact, 0.7)), asked_for(contact, 0.7), contact.mu
        w = (impulse - x) / e
        assert np.hypot(*impulse[1:]) <= mu * impulse[0] + 1e-14
        assert mu * np.hypot(*w[1:]) <= w[0] + 1e-13
        assert impulse @ w == pytest.approx(0.0, abs=1e-13)
        kinds.add((bool(impulse.any()), bool(np.abs(w).max() > 1e-12)))
    assert kinds == {(False, True), (True, False), (True, True)}  # the tip, inside, its surface


def test_stiffness_is_what_impulses_lose_by_velocities(rng) -> None:
    project = interpreted(response.make_projected_impulse(FRICTIONAL))
    stiffness = interpreted(response.make_stiffness(FRICTIONAL))
    h = 1e-6
    for contact in any_contact(rng):
        e = stiffness(contact)
        found = [[e.nn, e.n1, e.n2], [e.n1, e.t11, e.t12], [e.n2, e.t12, e.t22]]
        expected = np.zeros((3, 3))
        for k, axis in enumerate("n12"):
            name = f"velocity_{axis}"
            here, ends = contact[name], []
            for side in (h, -h):
                contact[name] = here + side
                ends.append(np.array(project(contact, 0.0)))
            contact[name] = here
            expected[:, k] = (ends[1] - ends[0]) / (2.0 * h)
        # Round-off 1e-16/h, curvature h^2: unless a kink lies within h.
        np.testing.assert_allclose(found, expected, atol=1e-8)


def test_without_friction_a_normal_never_pulls(rng) -> None:
    project = interpreted(response.make_projected_impulse(FRICTIONLESS))
    stiffness = interpreted(response.make_stiffness(FRICTIONLESS))
    for contact in any_contact(rng):
        (x, *_), (e, *_) = asked_for(contact, 0.7)
        assert project(contact, 0.7) == (pytest.approx(max(x, 0.0), abs=1e-15), 0.0, 0.0)
        pressed = asked_for(contact)[0][0] > 0.0
        assert stiffness(contact) == (e if pressed else 0.0, 0, 0, 0, 0, 0)


@pytest.mark.parametrize("spec", [FRICTIONAL, FRICTIONLESS], ids=["friction", "frictionless"])
def test_rows_are_those_of_the_jacobian(spec: Spec, rng) -> None:
    scene = drawn(spec, rng, PAIRS)
    _, _, contacts = views(scene)
    fill = interpreted(response.make_fill_rows(spec))
    kept = 3 if spec is FRICTIONAL else 1
    for k, (a, b) in enumerate(PAIRS):
        rows, own = np.zeros((9, DOF)), scene.jacobian[3 * k : 3 * k + kept]
        fill(contacts[k], rows)
        for side, i in ((OF_A, a), (OF_B, b)):
            found, expected = rows[side : side + kept], own[:, DOF * i : DOF * i + DOF]
            np.testing.assert_allclose(found, expected, atol=1e-15)


@pytest.mark.parametrize("at_rest", [True, False], ids=["at rest", "sliding"])
def test_a_round_starts_with_the_velocities_that_its_rows_ask_of(at_rest: bool, rng) -> None:
    """J v + target + belt, lifted by mu |v_t| where it slides; softness is 1/(E k)."""
    scene, softness = drawn(COMPLIANT, rng, PAIRS), 0.02
    rows = scene.contacts
    rows["surface_1"], rows["surface_2"] = rng.normal(size=(2, len(PAIRS)))
    _, velocities, contacts = views(scene)
    start = interpreted(response.make_start(COMPLIANT))
    start(contacts, len(PAIRS), velocities, softness, at_rest, False)
    w = (scene.jacobian @ scene.motion).reshape(-1, 3)
    w += np.stack([rows["target"], rows["surface_1"], rows["surface_2"]], axis=1)
    if not at_rest:
        w[:, 0] += rows["mu"] * np.hypot(w[:, 1], w[:, 2])
    found = np.stack([rows[f"velocity_{axis}"] for axis in "n12"], axis=1)
    np.testing.assert_allclose(found, w, atol=1e-14)
    # A damper 1/E and the compliance gamma of the row one behind the other: they add.
    damper = softness * rows["k_n"]
    np.testing.assert_allclose(rows["stiff_n"], 1.0 / (damper + rows["gamma"]), rtol=1e-14)
    np.testing.assert_allclose(rows["scale"], damper / (damper + rows["gamma"]), rtol=1e-14)
    np.testing.assert_allclose(rows["stiff_t"], 1.0 / (softness * rows["k_t"]), rtol=1e-14)
    for axis in "n12":
        np.testing.assert_array_equal(rows[f"start_{axis}"], rows[f"lambda_{axis}"])


def test_a_shift_follows_the_slip_and_stalled_ones_the_secant() -> None:
    """Of a slip 2 + s/2 the shift that it confirms is 4: a secant of two points is on it."""
    update = interpreted(response.update_shift)
    _, _, contacts = views(drawn(FRICTIONAL, np.random.default_rng(1), [(0, 1)]))
    contact = contacts[0]
    for expected in (2.0, 3.0, 3.5):
        update(contact, 2.0 + 0.5 * contact.shift, False)
        assert contact.shift == expected
    update(contact, 2.0 + 0.5 * contact.shift, True)
    assert contact.shift == pytest.approx(4.0, abs=1e-14)
    update(contact, -10.0, False)
    assert contact.shift == 0.0  # a lift, never a pull
