"""Forces, torques and drag on free bodies, against the discrete laws they are made of."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import Bench, body, plane, resolved, sphere

from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("drag", "external_force", "gravity", "rotation"))
DT, G = 1.0 / 240.0, 9.81
STEPS = 200
BRICK = {"kind": "box", "size": [0.2, 0.3, 0.5]}


def bench(gravity=(0.0, 0.0, 0.0), **properties) -> Bench:
    return Bench(resolved({"brick": body(BRICK, **properties)}, gravity), spec=SPEC)


def test_constant_force_gives_its_impulse() -> None:
    one = bench(mass=2.0)
    one.engine.bodies["fx"], one.engine.bodies["fz"] = 3.0, -5.0
    one.run(STEPS)
    # STEPS additions, each rounded to 1e-16 of the sum
    expected = np.array([3.0, 0.0, -5.0]) / 2.0 * STEPS * DT
    np.testing.assert_allclose(one.velocity[0], expected, rtol=STEPS * 2e-16)


@pytest.mark.parametrize("axis", range(3))
def test_constant_torque_about_a_principal_axis(axis: int) -> None:
    turn = (np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0)  # about y: body x to world -z, body z to world x
    one = bench(mass=2.0, orientation=turn)
    world = [(2, -1.0), (1, 1.0), (0, 1.0)][axis]
    one.engine.bodies["t" + "xyz"[world[0]]] = 0.1 * world[1]
    moment = one.cell["scene"]["bodies"]["brick"]["inertia"][axis]
    one.run(STEPS)
    expected = np.zeros(3)
    expected[world[0]] = 0.1 * world[1] / moment * STEPS * DT
    # the turn about that axis is rounded in every step, the axis drifts by 1e-16 each
    np.testing.assert_allclose(one.spin[0], expected, atol=STEPS * 1e-15 * abs(expected).max())


@pytest.mark.parametrize(("linear", "quadratic"), [(4.0, 0.0), (0.0, 2.5), (1.0, 1.5)])
def test_fall_ends_at_the_speed_at_which_drag_carries_the_weight(linear, quadratic) -> None:
    """(c1 + c2 v) v = m g, to round-off: the step is implicit, so dt does not enter."""
    one = bench((0.0, 0.0, -G), drag={"linear": linear, "quadratic": quadratic})
    one.run(20 * 240)  # the slowest tends to it with e^{-4 t}
    speed = -one.velocity[0, 2]
    assert (linear + quadratic * speed) * speed == pytest.approx(G, rel=1e-13)


def test_linear_drag_is_implicit_euler() -> None:
    one = bench(mass=2.0, velocity=(3.0, -1.0, 2.0), drag={"linear": 6.0})
    one.run(STEPS)
    factor = (1.0 + 6.0 * DT / 2.0) ** -STEPS
    expected = np.array([3.0, -1.0, 2.0]) * factor
    np.testing.assert_allclose(one.velocity[0], expected, rtol=STEPS * 4e-16)


@pytest.mark.parametrize("effects", [SPEC, SPEC.including("midpoint")], ids=["Euler", "midpoint"])
@pytest.mark.parametrize("coefficient", [1e3, 1e9])
def test_drag_of_any_size_slows_and_never_turns_back(coefficient: float, effects: Spec) -> None:
    drag = {"linear": coefficient, "quadratic": coefficient, "angular": coefficient}
    thrown = body(BRICK, velocity=(100.0, 0, 0), angular_velocity=(0, 0, 10.0), drag=drag)
    one = Bench(resolved({"brick": thrown}, (0.0, 0.0, 0.0)), spec=effects)
    speed, spin = 100.0, 10.0
    for _ in range(3):
        one.run(1)
        assert 0.0 <= one.velocity[0, 0] < speed
        assert 0.0 <= one.spin[0, 2] < spin
        speed, spin = one.velocity[0, 0], one.spin[0, 2]


def test_angular_drag_acts_axis_by_axis() -> None:
    one = bench(angular_velocity=(0.1, 0.2, 0.3), drag={"angular": 0.5})
    moments = np.array(one.cell["scene"]["bodies"]["brick"]["inertia"])
    one.run(1)
    expected = np.array([0.1, 0.2, 0.3]) / (1.0 + 0.5 * DT / moments)
    np.testing.assert_allclose(one.spin[0], expected, rtol=4e-16)


def test_no_drag_changes_no_bit() -> None:
    motion = {"velocity": (1.1, 2.3, -0.7), "angular_velocity": (0.3, 0.2, 0.9)}
    with_effect = bench((0.0, 0.0, -G), **motion)
    cell = with_effect.cell
    without = Bench(cell, spec=SPEC._replace(effects=("gravity", "rotation")))
    one, other = with_effect.run(STEPS), without.run(STEPS)
    assert one.pose.tobytes() == other.pose.tobytes()


def fallen(steps: int, drag: dict[str, float], seconds: int = 1) -> Bench:
    """Return a thing of 1 kg that fell from rest, by the midpoint rule."""
    cell = resolved({"brick": body(BRICK, drag=drag, angular_velocity=(0, 0, 5.0))}, (0, 0, -G))
    cell["numerics"]["timestep"] = f"{seconds}/{steps}"
    one = Bench(cell, spec=SPEC.including("midpoint"))
    one.run(steps)
    return one


@pytest.mark.parametrize("drag", [{"linear": 2.0}, {"quadratic": 0.5}])
def test_a_fall_by_the_midpoint_rule_is_of_second_order(drag: dict[str, float]) -> None:
    """m v' = m g - c1 v: v = v_t (1 - e^{-c1 t}); m v' = m g - c2 v^2: v = v_t tanh(g t/v_t)."""
    if "linear" in drag:
        exact = G / 2.0 * (1.0 - math.exp(-2.0))
    else:
        terminal = math.sqrt(G / 0.5)
        exact = terminal * math.tanh(G / terminal)
    errors = [abs(-fallen(n, drag).velocity[0, 2] - exact) for n in (40, 80, 160)]
    # The next term is of relative size dt/tau = 1/20 at the coarsest, tau half a second.
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)
    assert math.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.05)


def test_a_spin_decays_at_second_order() -> None:
    moment = resolved({"brick": body(BRICK)})["scene"]["bodies"]["brick"]["inertia"][2]
    exact = 5.0 * math.exp(-0.01 / moment)
    errors = [abs(fallen(n, {"angular": 0.01}).spin[0, 2] - exact) for n in (20, 40, 80)]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)
    assert math.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize(("linear", "quadratic"), [(4.0, 0.0), (0.0, 2.5), (1.0, 1.5)])
def test_a_fall_by_the_midpoint_rule_ends_at_the_same_speed(linear, quadratic) -> None:
    """Where v_0 is the terminal speed v' is, for any dt."""
    one = fallen(20 * 30, {"linear": linear, "quadratic": quadratic}, 20)
    speed = -one.velocity[0, 2]
    assert (linear + quadratic * speed) * speed == pytest.approx(G, rel=1e-13)


@pytest.mark.parametrize("impacts", ["at_surface", "in_order"])
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("e", [0.0, 0.5])
def test_drag_that_slows_an_approach_throws_nothing_back(
    impacts: str, turned: bool, e: float
) -> None:
    """A ball, or the end of a rod that spins, runs into a wall at 20 m/s; c dt/m = 2.

    A medium at rest takes energy, and so does an impact: after it there is at most e of the
    approach. They begin 1 mm inside, where impacts have no order. Of a rod of which the wall stops
    the end that moves (k_n = 4/m, impulse m u/4) a plastic impact leaves a quarter.
    """
    wall = plane(restitution=e)
    c = 2.0 / DT
    if turned:
        bar = {"kind": "box", "size": [1.0, 0.02, 0.02]}
        moving = {"velocity": (0.0, 0.0, -10.0), "angular_velocity": (0.0, 20.0, 0.0)}
        drag = {"linear": c, "angular": c / 12.0}
        one = body(bar, (0.0, 0.0, 0.009), restitution=e, drag=drag, **moving)
    else:
        one = sphere(0.1, (0, 0, 0.099), restitution=e, velocity=(0, 0, -20), drag={"linear": c})
    cell = resolved({"wall": wall, "one": one}, (0.0, 0.0, 0.0), timestep="1/240", impacts=impacts,
                    integrator="midpoint_contact", solver="adaptive", tolerance=1e-9)  # fmt: skip
    bench = interpreted_bench(cell)
    energy = [bench.run(1).step["kinetic_energy"][-1] for _ in range(4)]
    before = 0.5 * (10.0**2 + 20.0**2 / 12.0) if turned else 200.0
    least = 0.25 if turned else 0.0
    assert energy[0] <= (least + (1.0 - least) * e * e) * before + 1e-9
    assert all(later <= sooner + 1e-12 for sooner, later in itertools.pairwise(energy))
    if not turned:
        assert -1e-9 <= bench.velocity[1, 2] <= e * 20.0
