"""Nothing gains energy without a source: tumbling worlds of all shapes at the default numerics.

Sources that a step may have, each bounded by what it could give:
    solver       work of impulses that miss their law: sum |p| residual of their contacts, or
                 what the solver was asked for, where the rows of a body err together
    projection   m g times what it lifts, and omega^2 (I_max - I_min) angle / 2 of what it turns at
                 constant omega; it moves bodies that begin or end a step in each other
Restitution is none, whatever e is: where Newton's law would give energy Stronge's is taken.
"""

from __future__ import annotations

from typing import Any

import laboratory
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from zoo import FLOOR, GRAVITY, NOWHERE, SOME, Bench, bench, impulses, shape, share, zoos

STEPS = 40
TOLERANCE = 1e-9  # of the default numerics: what a row may miss its law by [m/s]
E_ZERO = st.just(0.0)
# Losses of a low coefficient hide gains: every other body gives back all.
LIVELY = st.one_of(share, st.just(1.0))


def energy(rows: Any) -> np.ndarray:
    return rows.step["kinetic_energy"] + rows.step["potential_energy"]


def projected(world: Bench, spins: np.ndarray, gravity: float) -> float:
    """Return the most that the step's projection can have given [J]."""
    if not world.engine.counters["projection_sweeps"][0]:
        return 0.0
    given_up = 0.0
    for body, push, spin in zip(world.engine.bodies, world.engine.state.pseudo, spins, strict=True):
        if body["inv_m"] > 0.0:
            moments = 1.0 / np.array([body["inv_ix"], body["inv_iy"], body["inv_iz"]])
            angle = float(np.linalg.norm([push["wx"], push["wy"], push["wz"]]))
            spread = moments.max() - moments.min()
            given_up += gravity * max(push["vz"], 0.0) / body["inv_m"]
            # d(omega I omega)/2 = omega . (angle x I omega): at most angle omega^2 spread / 2
            given_up += 0.5 * angle * float(spin @ spin) * spread
    return float(given_up)


def carried(world: Bench, before: np.ndarray, gravity: float) -> float:
    """Return what weight can give bodies that contacts carry [J]; before: their velocities.

    A carried body that a contact stops moves with the velocity that ends the step, one in an impact
    with those before and after the impact: weight works on another way than that of a fall between
    them, by up to m g (|change of v| dt + g dt^2/2). What rides on lasting contacts moves by the
    mean of both, and gets none of it; but only the last part of a step tells who does.
    """
    dt = float(world.engine.parameters["dt"][0])
    given_up = 0.0
    bodies, ways = world.engine.bodies, world.engine.state.motion
    for body, way, old, new in zip(bodies, ways, before, world.velocity, strict=True):
        if body["inv_m"] > 0.0 and way["carried"] > 0:
            changed = 0.0 if way["tau"] < dt else abs(float(new[2] - old[2]))
            given_up += gravity * dt * (changed + 0.5 * gravity * dt) / body["inv_m"]
    return float(given_up)


def check(bodies: dict[str, Any], gravity: Any, **numerics: Any) -> None:
    world = bench(bodies, gravity, **numerics)
    last = None
    for _ in range(STEPS):
        before = world.velocity.copy()
        rows = world.run(1)
        found = energy(rows)
        last = found[0] if last is None else last
        contacts = rows.contact
        pushes = np.linalg.norm(impulses(contacts), axis=1)
        allowed = float(pushes @ np.maximum(contacts["residual"], TOLERANCE))
        allowed += projected(world, world.spin, -gravity[2])
        allowed += carried(world, before, -gravity[2])
        # Sums of some ten terms, an implicit turn solved to round-off, and impacts whose gain is
        # round-off to 1e-13 of the works of their impulses; the jump of such a body's spin is the
        # root of a quadratic whose terms may be a hundred times what it gains.
        allowed += 1e-11 * float(rows.step["kinetic_energy"].max() + abs(found).max())
        assert found[-1] - last <= allowed
        last = found[-1]


@given(zoos(restitution=E_ZERO))
@SOME
def test_rough_plastic_worlds_gain_nothing(bodies):
    check(bodies, NOWHERE)


@given(zoos(restitution=E_ZERO, floor=True))
@SOME
def test_rough_plastic_worlds_on_a_floor_gain_nothing(bodies):
    check(bodies, GRAVITY)


@given(zoos(("sphere",), floor=True))
@SOME
def test_rough_bouncing_balls_gain_nothing(bodies):
    check(bodies, GRAVITY)


@pytest.mark.parametrize("floor", [False, True], ids=["free", "on a floor"])
@given(st.data())
@SOME
def test_rough_bouncing_worlds_gain_nothing(floor, data):
    bodies = data.draw(zoos(restitution=LIVELY, floor=floor))
    check(bodies, GRAVITY if floor else NOWHERE)


@given(zoos(count=(1, 1), restitution=LIVELY, friction=st.just(0.0), floor=True))
@SOME
def test_one_smooth_bouncing_body_gains_nothing(bodies):
    check(bodies, GRAVITY)


def test_a_body_whose_corners_strike_one_after_the_other_gains_nothing():
    """A hull of 0.3 J, all of it given back: its second corner strikes a step after its first."""
    turned = np.array([0.571, 0.364, 0.557, 0.481])
    hull = laboratory.body(
        shape("hull", 1.0),
        (0.0, 0.0, 0.04),
        orientation=turned / np.linalg.norm(turned),
        mass=3.0178,
        velocity=(0.48, -0.44, -1.67),
        angular_velocity=(3.83, 5.85, 5.06),
        restitution=1.0,
        friction=0.0,
    )
    check({"hull": hull, "floor": laboratory.plane(offset=FLOOR)}, GRAVITY)
