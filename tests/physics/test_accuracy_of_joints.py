"""Joints where an accuracy is asked for: pendulums, in one piece and two, and a bead on an arm.

The error is that of a place at the worst time of the run, relative to the path up to its end.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipj, ellipk
from shared_runs import GRAVITY, States, run_scenes
from test_error_control import asking
from test_joints_with_axes import HOOK, ROD, box, joined, joint

ACCURACIES = (1e-3, 1e-4, 1e-5, 1e-6)
DEGREES = (20, 60, 120, 170)  # amplitudes
HALF = 0.5  # from the hinge to the centre of the rod [m]
# Of the pendulum: sqrt(I/(m g d)), I about the hinge [s].
SWINGS = math.sqrt((HALF**2 + (ROD[0] ** 2 + ROD[2] ** 2) / 12.0) / (GRAVITY * HALF))
LONG, SHORT, HEAVY, LIGHT, WIDE = 1.0, 0.8, 2.0, 1.0, 0.1  # of two rods [m], [kg]
BEGIN = (1.0, 0.5)  # angles from the vertical [rad]
INNER, WHIRL = 0.3, 2.0  # where a bead begins on its arm, and how fast that turns [m], [rad/s]


def pendulum(degrees: int) -> str:
    a = math.radians(degrees)
    place = (HALF * math.sin(a), 0, -HALF * math.cos(a))
    bodies = {"hook": HOOK, "rod": box(ROD, 2.0, place, degrees=-degrees)}
    return joined(bodies, [joint("hinge", "hook", "rod", (0, 0.3, 0), (0, 1, 0))], 60, 1.9)


def swung(degrees: int, time: np.ndarray) -> np.ndarray:
    """sin(angle/2) = k sn(t/T + K), k = sin(a/2): released from rest at its amplitude."""
    k = math.sin(0.5 * math.radians(degrees))
    sn, *_ = ellipj(time / SWINGS + ellipk(k * k), k * k)
    angle = 2.0 * np.arcsin(k * sn)
    return HALF * np.stack([np.sin(angle), 0.0 * angle, -np.cos(angle)], axis=1)


def double_pendulum() -> str:
    a, b = BEGIN
    end = (LONG * math.sin(a), 0, -LONG * math.cos(a))
    below = (end[0] + 0.5 * SHORT * math.sin(b), 0, end[2] - 0.5 * SHORT * math.cos(b))
    bodies = {
        "hook": HOOK,
        "upper": box((WIDE, WIDE, LONG), HEAVY, np.multiply(0.5, end), degrees=-math.degrees(a)),
        "rod": box((WIDE, WIDE, SHORT), LIGHT, below, degrees=-math.degrees(b)),
    }
    across = (0, 1, 0)
    joints = [
        joint("hinge", "hook", "upper", (0, 0, 0), across),
        joint("hinge", "upper", "rod", end, across),
    ]
    return joined(bodies, joints, 60, 1.6)


def double_swung(time: np.ndarray) -> np.ndarray:
    """Lagrange's equations of both angles, by a method of order 8 to 1e-12."""
    upper = HEAVY * (WIDE**2 + LONG**2) / 12.0 + (HEAVY / 4.0 + LIGHT) * LONG**2
    lower = LIGHT * ((WIDE**2 + SHORT**2) / 12.0 + SHORT**2 / 4.0)

    def change(_: float, y: np.ndarray) -> list[float]:
        a, b, p, q = y
        both = 0.5 * LIGHT * LONG * SHORT
        shared, whirl = both * math.cos(a - b), both * math.sin(a - b)
        f = -whirl * q * q - (HEAVY / 2.0 + LIGHT) * GRAVITY * LONG * math.sin(a)
        g = whirl * p * p - 0.5 * LIGHT * GRAVITY * SHORT * math.sin(b)
        d = upper * lower - shared * shared
        return [p, q, (lower * f - shared * g) / d, (upper * g - shared * f) / d]

    begin = [*BEGIN, 0.0, 0.0]
    found = solve_ivp(
        change, (0, time[-1]), begin, method="DOP853", rtol=1e-12, atol=1e-13, t_eval=time
    )
    a, b = found.y[:2]
    x = LONG * np.sin(a) + 0.5 * SHORT * np.sin(b)
    return np.stack([x, 0.0 * x, -LONG * np.cos(a) - 0.5 * SHORT * np.cos(b)], axis=1)


def parted() -> str:
    """The same pendulum at 60 degrees of two halves that a fixed joint makes one."""
    a = math.radians(60)
    along, half = np.array([math.sin(a), 0, -math.cos(a)]), (ROD[0], ROD[1], 0.5 * ROD[2])
    bodies = {
        "hook": HOOK,
        "upper": box(half, 1.0, 0.25 * along, degrees=-60),
        "rod": box(half, 1.0, 0.75 * along, degrees=-60),
    }
    joints = [
        joint("hinge", "hook", "upper", (0, 0.3, 0), (0, 1, 0)),
        joint("fixed", "upper", "rod", 0.5 * along),
    ]
    return joined(bodies, joints, 60, 1.9)


def beaded() -> str:
    """A bead that slides along an arm which turns freely about the vertical."""
    whirls = {"spin": (0, 0, WHIRL)}
    bodies = {
        "hook": HOOK,
        "arm": box((LONG, WIDE, WIDE), HEAVY, (0, 0, 0), **whirls),
        "rod": box((WIDE, WIDE, WIDE), LIGHT, (INNER, 0, 0), (0, INNER * WHIRL, 0), **whirls),
    }
    joints = [
        joint("hinge", "hook", "arm", (0, 0, 0), (0, 0, 1)),
        joint("slider", "arm", "rod", (INNER, 0, 0), (1, 0, 0)),
    ]
    return joined(bodies, joints, 60, 1.2)


def thrown_out(time: np.ndarray) -> np.ndarray:
    """r'' = r w^2, (I + m r^2) w kept; by a method of order 8 to 1e-12."""
    inertia = HEAVY * (LONG**2 + WIDE**2) / 12.0 + LIGHT * WIDE**2 / 6.0
    momentum = (inertia + LIGHT * INNER**2) * WHIRL

    def change(_: float, y: np.ndarray) -> list[float]:
        w = momentum / (inertia + LIGHT * y[0] ** 2)
        return [y[1], y[0] * w * w, w]

    found = solve_ivp(
        change,
        (0, time[-1]),
        [INNER, 0.0, 0.0],
        method="DOP853",
        rtol=1e-12,
        atol=1e-13,
        t_eval=time,
    )
    r, _, angle = found.y
    return np.stack([r * np.cos(angle), r * np.sin(angle), 0.0 * r], axis=1)


def worst(states: States, place: np.ndarray, fine: np.ndarray) -> float:
    off = np.linalg.norm(states.of("rod")[0] - place, axis=1).max()
    return float(off / np.linalg.norm(np.diff(fine, axis=0), axis=1).sum())


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {f"{d} {a}": asking(pendulum(d), a) for d in DEGREES for a in ACCURACIES}
    ball = joint("ball", "hook", "rod", (0, 0, 0))
    hinge = joint("hinge", "hook", "rod", (0, 0.3, 0), (0, 1, 0))
    for accuracy in ACCURACIES:  # it stays in its plane on a ball joint, too
        text = texts[f"60 {accuracy}"]
        assert hinge in text
        texts[f"ball {accuracy}"] = text.replace(hinge, ball)
    others = {"double": double_pendulum(), "parted": parted(), "bead": beaded()}
    texts |= {f"{name} {a}": asking(text, a) for name, text in others.items() for a in ACCURACIES}
    return run_scenes(texts)


@pytest.fixture(scope="module")
def achieved(ran: dict[str, States]) -> dict[str, float]:
    found = {}
    for accuracy in ACCURACIES:
        for degrees in DEGREES:
            states = ran[f"{degrees} {accuracy}"]
            fine = swung(degrees, np.linspace(0.0, states.time[-1], 2000))
            found[f"{degrees} {accuracy}"] = worst(states, swung(degrees, states.time), fine)
        states = ran[f"ball {accuracy}"]
        fine = swung(60, np.linspace(0.0, states.time[-1], 2000))
        found[f"ball {accuracy}"] = worst(states, swung(60, states.time), fine)
        states = ran[f"parted {accuracy}"]
        fine = 1.5 * swung(60, np.linspace(0.0, states.time[-1], 2000))
        found[f"parted {accuracy}"] = worst(states, 1.5 * swung(60, states.time), fine)
        for name, truth in (("double", double_swung), ("bead", thrown_out)):
            states = ran[f"{name} {accuracy}"]
            place = truth(states.time)
            found[f"{name} {accuracy}"] = worst(states, place, place)
    return {name: off / float(name.split()[1]) for name, off in found.items()}


def test_no_pendulum_is_off_by_ten_times_what_is_asked_for(achieved: dict[str, float]) -> None:
    assert max(achieved.values()) <= 10.0


def test_pendulums_are_off_by_a_tenth_of_what_is_asked_for_in_nine_of_ten_cases(
    achieved: dict[str, float], ran: dict[str, States]
) -> None:
    """But where the longest substeps, two a step, are more accurate: the bead's of 1e-3, 1e-4."""
    least = {name: 2 * (len(states.time) - 1) for name, states in ran.items()}
    taken = {name: states.step["substeps"].sum() for name, states in ran.items()}
    enough = [share >= 0.1 for name, share in achieved.items() if taken[name] > least[name]]
    assert len(enough) >= len(achieved) - 2
    assert sum(enough) >= 0.9 * len(enough)


def test_estimates_of_joints_add_up_to_what_they_may(ran: dict[str, States]) -> None:
    """Three times the accuracy in smooth motion, once more at kinks; energy is no worse."""
    for name, states in ran.items():
        accuracy, energy = float(name.split()[1]), states.energy()
        assert 0.0 < states.step["estimated_error"].sum() <= 4.0 * accuracy
        lowest = LONG if name.startswith(("double", "parted", "bead")) else HALF
        assert np.ptp(energy) <= accuracy * 2.0 * GRAVITY * lowest
