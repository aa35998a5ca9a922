"""Groups of bodies that springs join: who is in one, its momenta and its spin, against numpy."""

from __future__ import annotations

import numpy as np

from lavendersim.engine.compile import inner
from lavendersim.engine.effects.spring import make_place
from lavendersim.engine.record_layout import allocate_bodies, allocate_links, allocate_velocities
from lavendersim.engine.rotation import orient
from lavendersim.engine.spec import Spec
from lavendersim.engine.spring_group import make_group
from lavendersim.engine.vectors import Vec3

SPEC = Spec(("gyroscopic", "midpoint", "rotation", "spring"), ("box_plane",))
GROUP = make_group(SPEC, make_place(SPEC))
LABEL, CENTRE_OF, MOMENTUM_OF = GROUP.label, GROUP.centre_of, GROUP.momentum_of
RIGID_SPIN, STORED = GROUP.rigid_spin, GROUP.stored


@inner
def label(links, bodies):
    LABEL(links, bodies)


@inner
def put(out, v):
    out[0], out[1], out[2] = v.x, v.y, v.z


@inner
def measure(links, bodies, velocities, h, vectors):
    # centre, V, h and omega_c of `h` into rows; returns mass, energy beside the centre's, stored.
    for i in range(bodies.shape[0]):
        orient(bodies[i])
    mass, centre, speed = CENTRE_OF(bodies, velocities, 1)
    momentum, energy = MOMENTUM_OF(bodies, velocities, 1, centre, speed)
    put(vectors[0], centre)
    put(vectors[1], speed)
    put(vectors[2], momentum)
    put(vectors[3], RIGID_SPIN(bodies, 1, centre, Vec3(h[0], h[1], h[2])))
    return mass, energy, STORED(links, bodies, 1)


def test_springs_join_all_that_move_and_a_fixed_body_joins_none() -> None:
    bodies, links = allocate_bodies(SPEC, 7), allocate_links(SPEC, 5)
    bodies["inv_m"] = (1, 1, 0, 1, 1, 1, 1)
    for link, ends in zip(links, ((3, 1), (4, 3), (1, 2), (5, 2), (5, 6)), strict=True):
        link["a"], link["b"], link["active"] = *ends, 1
        bodies["joined"][list(ends)] = 1
    label(links, bodies)
    assert bodies["group"].tolist() == [0, 2, 0, 2, 2, 6, 6]
    links["active"][1] = 0
    label(links, bodies)
    assert bodies["group"].tolist() == [0, 2, 0, 2, 5, 6, 6]


def test_momenta_energy_and_rigid_spin_are_the_sums(rng: np.random.Generator) -> None:
    count = 3
    bodies, links = allocate_bodies(SPEC, count), allocate_links(SPEC, 1)
    velocities = allocate_velocities(SPEC, count)
    mass, inertia = rng.uniform(0.5, 2.0, count), rng.uniform(0.5, 2.0, count)
    place, speed, spin = rng.normal(size=(3, count, 3))
    bodies["inv_m"], bodies["qw"], bodies["group"] = 1.0 / mass, 1.0, 1
    for k, axis in enumerate("xyz"):
        bodies[axis], bodies[f"inv_i{axis}"] = place[:, k], 1.0 / inertia
        velocities[f"v{axis}"], velocities[f"w{axis}"] = speed[:, k], spin[:, k]
    links[0]["b"], links[0]["active"], links[0]["stiffness"] = 1, 1, 7.0
    h = rng.normal(size=3)
    vectors = np.zeros((4, 3))
    total, energy, stored = measure(links, bodies, velocities, h, vectors)
    centre, mean, momentum, found = vectors
    r = place - mass @ place / mass.sum()
    u = speed - mass @ speed / mass.sum()
    # Sums of some ten terms of the order of one.
    bound = {"atol": 1e-13}
    assert total == mass.sum()
    np.testing.assert_allclose(centre, mass @ place / mass.sum(), **bound)
    np.testing.assert_allclose(mean, mass @ speed / mass.sum(), **bound)
    np.testing.assert_allclose(momentum, mass @ np.cross(r, u) + inertia @ spin, **bound)
    both = mass @ (u * u).sum(1) + inertia @ (spin * spin).sum(1)
    np.testing.assert_allclose(energy, 0.5 * both, **bound)
    whole = inertia.sum() * np.eye(3)
    for m, x in zip(mass, r, strict=True):
        whole += m * (x @ x * np.eye(3) - np.outer(x, x))
    np.testing.assert_allclose(found, np.linalg.solve(whole, h), **bound)
    np.testing.assert_allclose(stored, 3.5 * ((place[1] - place[0]) ** 2).sum(), **bound)
