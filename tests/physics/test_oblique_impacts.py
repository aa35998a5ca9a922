"""Oblique impacts of a solid ball with Mindlin's stiffness along its surface, and a damped swing.

Twelve angles from what sticks to what slips throughout, by psi = kappa v_t/(mu v_n) before and
after (Maw, Barber and Fawcett 1976; cited as background, not opened), kappa = 2 (1 - nu)/(2 - nu):
    m u' = F_n,   v_t' = 7/2 F_t/m,   F_t = -k_t s,   |F_t| <= mu F_n,   v_t = s' + w
Judged by explicit steps of 1e-6 s in which F_t is that of a spring, cut at mu F_n. Of Hertz's
contact k_t grows with its depth: while it does the force is kept, then the stretch. What slips
throughout (psi above 7 kappa - 1) ends with psi - 7 kappa, by any law of the normal.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, ball, config, orders, plane, run_scenes

MASS, RADIUS, SPEED, MU = 2.0, 0.1, 1.0, 0.3  # [kg], [m], [m/s], [-]
NU = 0.3
KAPPA = 2.0 * (1.0 - NU) / (2.0 - NU)
C, K = 1e-5, 1e6  # [m/N], [N/m^1.5]
RATE = 4000
PSI = (0.2, 0.5, 0.8, 1.1, 1.6, 2.2, 2.8, 3.4, 4.0, 4.6, 5.2, 6.5)
LAWS = ("linear", "hertz")
LASTS = {  # [s]
    "linear": math.pi * math.sqrt(MASS * C),
    "hertz": 2.943 * (1.25 * MASS * SPEED**2 / K) ** 0.4 / SPEED,
}
ZETA, START, SWINGS = 0.3, 0.02, (500, 1000, 2000)
K_T = KAPPA / C
OMEGA = math.sqrt(3.5 * K_T / MASS)


def surface(law: str, more: str = "") -> str:
    """Return one of two equal surfaces, which are indented one behind the other."""
    normal = {"linear": f"compliance: {C / 2}", "hertz": f"hertz_stiffness: {2.0**1.5 * K!r}"}
    return f"{normal[law]}, friction: {MU}, tangential_stiffness: {KAPPA!r}{more}"


def scenes() -> dict[str, str]:
    """Return all scenes of this file by name."""
    found = {}
    for law in LAWS:
        for psi in PSI:
            slip = psi * MU * SPEED / KAPPA
            thrown = ball(RADIUS, MASS, (0, 0, RADIUS + 1e-4), (slip, 0, -SPEED))
            bodies = {"floor": plane(), "ball": thrown}
            found[f"{law} {psi}"] = config(bodies, RATE, 0.025, surface(law))
    more = f", tangential_damping_ratio: {ZETA}"
    for rate in SWINGS:
        resting = ball(RADIUS, MASS, (0, 0, RADIUS - MASS * GRAVITY * C), (START, 0, 0))
        bodies = {"floor": plane(), "ball": resting}
        down = f"[0, 0, {-GRAVITY}]"
        found[f"swing {rate}"] = config(bodies, rate, 0.03, surface("linear", more), down)
    return found


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    return run_scenes(scenes())


@pytest.fixture(scope="module")
def small_steps() -> dict[str, np.ndarray]:
    return {law: in_small_steps(law) for law in LAWS}


def slips(states: States) -> np.ndarray:
    """Return the velocity of the ball's lowest point along x (k + 1,) [m/s]."""
    _, v, spin = states.of("ball")
    return v[:, 0] - RADIUS * spin[:, 1]


def in_small_steps(law: str) -> np.ndarray:
    """Return the slip that an impact at each of PSI leaves [m/s], by steps of 1e-6 s."""
    dt, depth, approach = 1e-6, 0.0, SPEED
    slip = np.array(PSI) * MU * SPEED / KAPPA
    along, before = np.zeros_like(slip), 0.0  # F_t and the stiffness that it had
    while True:
        depth += dt * approach
        if depth <= 0.0:
            return slip
        if law == "linear":
            force, stiff = depth / C, KAPPA / C
        else:
            force, stiff = K * depth**1.5, 1.5 * KAPPA * K * math.sqrt(depth)
        along *= min(stiff / before, 1.0) if before > 0.0 else 0.0
        along = np.clip(along - dt * stiff * slip, -MU * force, MU * force)
        before = stiff
        approach -= dt * force / MASS
        slip = slip + dt * 3.5 * along / MASS


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("psi", PSI)
def test_an_oblique_impact_leaves_as_in_small_steps(
    ran: dict[str, States], small_steps: dict[str, np.ndarray], psi: float, law: str
) -> None:
    """Of n steps an impact a share of (pi/n)^2/12 of its phases, and of kinks within a step.

    A kink adds up to half the change of force of a step, over that step: (pi/n)^2/2 of 7 mu u.
    """
    found = slips(ran[f"{law} {psi}"])[-1]
    steps = LASTS[law] * RATE
    bound = 0.5 * (math.pi / steps) ** 2 * 7.0 * MU * SPEED
    assert abs(found - small_steps[law][PSI.index(psi)]) < bound
    if psi > 7.0 * KAPPA - 1.0:
        assert found == pytest.approx((psi - 7.0 * KAPPA) * MU * SPEED / KAPPA, abs=bound)


def test_what_sticks_first_has_its_slip_turned_round_and_what_slips_has_not(
    ran: dict[str, States],
) -> None:
    """The curve of psi_2: below 0 at middle angles, above it where it slips throughout."""
    for law in LAWS:
        ends = [slips(ran[f"{law} {psi}"])[-1] for psi in PSI]
        assert min(ends[3:8]) < -0.1 * MU * SPEED < 0.0 < ends[-1]


def test_a_damped_swing_is_that_of_its_ratio(ran: dict[str, States]) -> None:
    """s'' + 2 zeta omega s' + omega^2 s = 0, order 2: a share of some (omega dt)^2 of the start."""
    damped = OMEGA * math.sqrt(1.0 - ZETA**2)
    errors = []
    for rate in SWINGS:
        states = ran[f"swing {rate}"]
        phase, decay = damped * states.time, np.exp(-ZETA * OMEGA * states.time)
        slope = ZETA / math.sqrt(1.0 - ZETA**2)
        expected = START * decay * (np.cos(phase) - slope * np.sin(phase))
        errors.append(np.abs(slips(states) - expected).max())
    assert min(orders(errors)) > 1.7
    assert errors[-1] < START * (OMEGA / SWINGS[-1]) ** 2


def test_a_damper_takes_its_own_work_and_no_more(ran: dict[str, States]) -> None:
    """k_d (s_1 - s_0)^2/dt in each step, k_d = 2 zeta sqrt(2/7 m k_t); round-off of 2e-2 J."""
    states = ran["swing 500"]
    rows = states.contact  # t2 = n x t1, and n is along z
    stretch = rows["stretch_t1"] * rows["t1x"] - rows["stretch_t2"] * rows["nz"] * rows["t1y"]
    damper = 2.0 * ZETA * math.sqrt(2.0 / 7.0 * MASS * K_T)
    lost = -np.diff(states.energy() + states.step["contact_energy"])[1:]  # the start is in no log
    taken = damper * np.diff(stretch) ** 2 * 500
    np.testing.assert_allclose(lost, taken, rtol=1e-9, atol=1e-13)
    assert taken.sum() > 0.1 * 0.5 * 2.0 / 7.0 * MASS * START**2
