"""What an isolated world of any shapes keeps: frictional, bouncing, soft, at default numerics.

Every impulse acts on two bodies with opposite signs: momentum is kept to round-off. Its moment is
kept where both act on one line at one instant, as the impacts of rigid bodies do, one after the
other (`impact_order`). What is no impact takes time: a soft contact, and the touch of rigid bodies
between impacts where others push them, too. Their bodies move on while the line stays that of one
pose, so one contact may change the moment by

    dL = (phi n + v t) x p + (I(t) - I(0)) domega,   v, t <= dt: of the centres; p on B

the first with the gap's and the motion's lever, the last because the jump of the spin is that of
another pose. All are of first order in dt. The bound below takes each at its largest.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from zoo import DT, SHAPES, SOME, Bench, bench, impulses, run, soft, vectors, zoos

STEPS = 40


def mass_speeds(bodies):
    """Return sum m (|v| + |omega| 0.3 m): the size of what is summed up [kg m/s]."""
    spins = (0.3 * np.linalg.norm(b["angular_velocity"]) for b in bodies.values())
    speeds = (np.linalg.norm(b["velocity"]) for b in bodies.values())
    masses = (b["mass"] for b in bodies.values())
    return sum(m * (v + w) for m, v, w in zip(masses, speeds, spins, strict=True))


@given(zoos(compliance=soft))
@SOME
def test_momentum_is_kept_to_round_off(bodies):
    momentum = vectors(run(bodies, STEPS).step, "momentum_")
    # Some ten impacts of some hundred updates each round p once: a walk of 1e-16 sqrt(1000).
    assert np.abs(momentum - momentum[0]).max() < 1e-13 * mass_speeds(bodies)


def first_order(world: Bench, before: np.ndarray, spins: np.ndarray, contacts) -> float:
    """Return the bound of |dL| of one step, given the centres' velocities and spins before it."""
    rows = world.engine.bodies
    bound = 0.0
    for contact, p in zip(contacts, impulses(contacts), strict=True):
        a, b = int(contact["body_a"]), int(contact["body_b"])
        push = float(np.linalg.norm(p))
        flight = DT * float(np.linalg.norm(before[b] - before[a]))
        bound += push * (flight + abs(contact["separation"]))
        for i in (a, b):
            inverse = np.array([rows[i]["inv_ix"], rows[i]["inv_iy"], rows[i]["inv_iz"]])
            moments = 1.0 / inverse
            # A matrix of eigenvalues I_k that turns by an angle changes by at most twice their
            # spread times it; the jump is I^-1 (r x p), r no longer than the body's bound.
            turn = min(1.0, DT * float(np.linalg.norm(spins[i])))
            jump = (float(rows[i]["bound"]) + abs(contact["separation"])) * push / moments.min()
            bound += 2.0 * turn * (moments.max() - moments.min()) * jump
    return bound


@given(zoos(compliance=soft))
@SOME
def test_moment_of_momentum_changes_by_the_motion_under_contacts_and_nothing_else(bodies):
    """Without projection, which turns a body at constant omega and so changes its I omega."""
    world = bench(bodies, projection=0.0)
    world.run(0)
    size = mass_speeds(bodies)
    start = None
    for _ in range(STEPS):
        before, spins = world.velocity, world.spin
        rows = world.run(1)
        moments = vectors(rows.step, "angular_momentum_")
        start = moments[0] if start is None else start
        allowed = first_order(world, before, spins, rows.contact) + 1e-13 * size
        assert np.linalg.norm(moments[-1] - start) <= allowed
        start = moments[-1]


@pytest.mark.parametrize(
    ("kinds", "count"),
    [pytest.param(("sphere",), (2, 5), id="balls"), pytest.param(SHAPES, (2, 2), id="any two")],
)
@given(st.data())
@SOME
def test_moment_of_momentum_of_what_only_strikes_is_kept_to_round_off(kinds, count, data):
    bodies = data.draw(zoos(kinds, count))
    rows = run(bodies, STEPS).step
    angular = vectors(rows, "angular_momentum_")
    # What begins overlapping is moved apart, by turns at constant spin: no impact by itself.
    strikes = rows["unordered"][1:] == 0
    changes = np.abs(np.diff(angular, axis=0)[strikes])
    # Sums as above, of levers of some metres; and surfaces meet to 1e-9 m squared, by Newton.
    assert changes.max(initial=0.0) < 1e-12 * mass_speeds(bodies)
