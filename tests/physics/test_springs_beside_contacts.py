"""Springs that act on bodies beside contacts give no energy, however stiff and far off the centres.

Drawn nets of uneven boxes over a floor, of which springs tie the first to it: they hit the floor
and each other, slide and are drawn over it, with and without gravity and rebound. The energy of
bodies, springs and heights falls in every step, also where a step does not resolve a spring. Rigid
contacts do that beside others that give way, too: the plan of these scenes has springs of contacts.
Where their own contacts give way, what these store counts, and the energy stays below its start.

A block on a spring that slides over a floor turns round within a step, which has two parts then:
what springs did in both is logged of it.
"""

from __future__ import annotations

import numpy as np
import pytest
from shared_runs import GRAVITY, States, config, flow, orders, plane, run_scenes
from test_springs_at_the_middle import spring

from tests.thorough import THOROUGH

# k K dt^2 of the stiffest spring, friction, steps a second; restitution, gravity.
Net = tuple[float, float, int, float, float]
NETS: list[Net] = [
    (softness, friction, rate, restitution, gravity)
    for restitution, gravity, softnesses, rates in (
        (0.0, 0.0, (1.0, 30.0, 1e3, 1e5), (60, 240)),
        (0.0, GRAVITY, (30.0, 1e3), (60, 240)),
        (1.0, GRAVITY, (30.0, 1e5), (60,)),
    )
    for softness in softnesses
    for friction in (0.0, 0.5)
    for rate in rates
]
# Those that are run: each rate beside one of two frictions.
RUN = {one: k for k, one in enumerate(NETS) if THOROUGH or (k + k // 2) % 2 == 0}


def net(
    number: int, softness: float, friction: float, rate: int, restitution: float, gravity: float
) -> str:
    """Three boxes above each other, 20 mm apart at least, that fly and turn."""
    draw = np.random.default_rng(number)
    bodies, springs, height, before = {"floor": plane()}, "", 0.0, np.zeros(3)
    for i in range(3):
        size = 10.0 ** draw.uniform(-1.3, -0.3, 3)
        mass = float(10.0 ** draw.uniform(-1.0, 1.0))
        height += 0.5 * float(np.linalg.norm(size)) + 0.02
        bodies[f"b{i}"] = (
            f"{{shape: {{kind: box, size: {flow(size)}}}, mass: {mass!r}, surface: one, "
            f"position: {flow([*draw.normal(0.0, 0.1, 2), height])}, "
            f"velocity: {flow(draw.normal(size=3))}, "
            f"angular_velocity: {flow(draw.normal(size=3))}}}"
        )
        height += 0.5 * float(np.linalg.norm(size)) + 0.02
        point = draw.normal(size=3) * size * 0.5
        least = mass / 6.0 * float(np.sort(size * size)[0])
        stiffness = float(softness * rate**2 / (1.0 / mass + point @ point / least))
        near = draw.normal(size=3) * (before * 0.5 if i else np.array([0.1, 0.1, 0.0]))
        ends = f", point_a: {flow(near)}, point_b: {flow(point)}"
        springs += spring(f"b{i - 1}" if i else "floor", f"b{i}", stiffness, 0.1, ends)
        before = size
    surface = f"restitution: {restitution}, friction: {friction}"
    text = config(bodies, rate, 40.0 / rate, surface, f"{gravity}")
    return text.replace("  bodies:\n", f"  springs:\n{springs}  bodies:\n", 1)


# Beside contacts that give way, with steps that resolve these.
SOFT: list[Net] = [(1e3, 0.5, 240, 0.0, 0.0), (30.0, 0.5, 240, 0.0, GRAVITY)]
COMPLIANCE = "restitution: 0.0, compliance: 1.0e-3"


def soft(one: Net) -> str:
    return net(RUN[one], *one).replace("restitution: 0.0", COMPLIANCE, 1)


STIFFNESS, FRICTION, START = 50.0, 0.1, 0.3  # [N/m], [-], [m] of a block of 1 kg
RATES = (60, 120, 240)


def sliding_block(rate: int) -> str:
    """A block that a spring draws to and fro over a floor: friction takes 2 mu m g/k a swing."""
    block = (
        "{shape: {kind: box, size: [0.4, 0.4, 0.1]}, mass: 1.0, surface: one, "
        f"position: {flow((START, 0.0, 0.05))}}}"
    )
    bodies = {"floor": plane(), "block": block}
    text = config(bodies, rate, 1.5, f"friction: {FRICTION}", f"{GRAVITY}")
    tied = spring("floor", "block", STIFFNESS, 1.0, ", point_a: [-1.0, 0.0, 0.05]")
    return text.replace("  bodies:\n", f"  springs:\n{tied}  bodies:\n", 1)


def way_of_block(time: np.ndarray) -> np.ndarray:
    """Return where it is: half a circle about +-mu m g/k after the other."""
    omega, middle = np.sqrt(STIFFNESS), FRICTION * GRAVITY / STIFFNESS
    swing = np.floor(omega * time / np.pi)
    side = 1.0 - 2.0 * (swing % 2)
    return side * middle + (START - middle * (1.0 + 2.0 * swing)) * np.cos(omega * time)


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    scenes = {f"{one}": net(number, *one) for one, number in RUN.items()}
    scenes |= {f"block {rate}": sliding_block(rate) for rate in RATES}
    return run_scenes(scenes | {f"soft {one}": soft(one) for one in SOFT})


@pytest.mark.parametrize("one", RUN)
def test_springs_beside_contacts_give_no_energy(ran: dict[str, States], one: Net) -> None:
    states = ran[f"{one}"]
    energy = states.energy() + states.step["spring_energy"]
    # A solve leaves 1e-9 m/s of velocities of some m/s, against impulses of what is stored. What
    # overlaps is lifted out of it, against gravity.
    depth = np.zeros(len(energy))
    np.maximum.at(depth, states.contact["step"], states.contact["penetration"])
    weight = one[4] * 3.0 * 10.0  # of three bodies of at most 10 kg
    assert (np.diff(energy) - weight * depth[1:]).max() <= 1e-9 * energy[0]
    assert len(states.contact) > 0, "nothing touches"


@pytest.mark.parametrize("one", SOFT)
def test_springs_beside_contacts_that_give_way_win_nothing(
    ran: dict[str, States], one: Net
) -> None:
    states = ran[f"soft {one}"]
    energy = states.energy() + states.step["spring_energy"] + states.step["contact_energy"]
    # A contact spring acts through the step in which it is met: (v dt)^2/(2 c) for some 0.3 m/s of
    # what is 0.01 m from a body; `contact_energy` begins at 0 though bodies overlap.
    assert energy.max() <= 1.01 * energy[0]
    assert states.step["contact_energy"].max() > 1e-3 * energy[0], "nothing gives way"


@pytest.mark.parametrize("rate", RATES)
def test_what_springs_do_in_all_parts_of_a_step_is_logged(
    ran: dict[str, States], rate: int
) -> None:
    """Momentum is what contacts and the spring gave, in the steps in which it turns round too."""
    states = ran[f"block {rate}"]
    rows, step = states.contact, states.step
    normal, along = (
        np.stack([rows[f"{name}{axis}"] for axis in "xyz"], axis=1) for name in ("n", "t1")
    )
    push = rows["impulse_t1"][:, None] * along
    push += rows["impulse_t2"][:, None] * np.cross(normal, along)
    friction = np.bincount(rows["step"], push[:, 0], len(step))
    given = friction + step["spring_impulse_x"]
    assert (step["parts"] > 1).sum() == 3  # 1.5 s are 3.4 swings
    # Sums of some impulses of 1 N s, of which contacts leave 1e-9 m/s.
    np.testing.assert_allclose(np.diff(step["momentum_x"]), given[1:], rtol=0, atol=2e-9)


def test_a_block_on_a_spring_turns_round_at_second_order(ran: dict[str, States]) -> None:
    errors = []
    for rate in RATES:
        states = ran[f"block {rate}"]
        errors.append(np.abs(states.of("block")[0][:, 0] - way_of_block(states.time)).max())
    # The midpoint rule lags by (w h)^2/12 of w t = 10.6: 1.2 % of the first swing at 1/60.
    assert errors[0] < 0.013 * START
    assert min(orders(errors)) > 1.8
