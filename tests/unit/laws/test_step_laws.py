"""Each law of a step is named where it alone is broken, with the number of its closed form."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from made_motion import BALLS, DT, MASS, RADIUS, G, ball, given, motion, states

from lavendersim.laws.judging import JudgedLaws, judge_laws
from lavendersim.laws.step_laws import LAWS, _cost

REST = [0.0, 0.0, RADIUS]
WEIGHT = MASS * G * DT  # [N s] that the floor gives a ball at rest
# Numbers of order 0.1 to 10, some hundred roundings of 1e-16 each.
EXACT = 1e-12


def judged(before: list[float], impulse: list[float], **config: float) -> JudgedLaws:
    """Return the laws of a step in which the ball on the floor gets an impulse [N s]."""
    gravity = config.get("gravity", G)
    after = np.array(before) + given(impulse)
    after[2] -= gravity * DT
    place = np.array(REST) + DT * after[:3]
    return judge_laws(motion(ball(**config), *states((REST, before), (place, after))))


def numbers(found: JudgedLaws) -> dict[str, float]:
    return {law: float(found.numbers[law][0]) for law in LAWS}


def only(found: JudgedLaws, *laws: str) -> None:
    """Check that no other law is broken."""
    assert {law for law, number in numbers(found).items() if number > EXACT} == set(laws)


def test_a_ball_at_rest_breaks_none() -> None:
    found = judged([0.0] * 6, [0.0, 0.0, WEIGHT])
    only(found)
    assert found.named is None


def test_a_ball_that_slides_by_coulombs_law_breaks_none() -> None:
    only(judged([1.0, 0.5, 0.0, 0.0, 0.0, 0.0], friction_against(1.0, 0.5)))


def friction_against(x: float, y: float) -> list[float]:
    size = np.hypot(x, y)
    return [-0.5 * WEIGHT * x / size, -0.5 * WEIGHT * y / size, WEIGHT]


def test_a_body_that_gained_momentum() -> None:
    """In the air nothing can push it: all that it gained is left, and who it is."""
    pose, velocity = states(([0, 0, 2], [0] * 6), ([0, 0, 2], [0.3, 0, -G * DT, 0, 0, 0]))
    found = judge_laws(motion(ball(), pose, velocity))
    only(found, "momentum")
    assert found.named is not None
    assert (found.named.law, found.named.bodies, found.named.step) == ("momentum", ("ball",), 1)
    assert found.named.violation.number == pytest.approx(0.3 * MASS, rel=EXACT)
    assert found.named.violation.velocity == pytest.approx(0.3, rel=EXACT)


def test_a_body_that_gained_spin() -> None:
    """Counted as the linear momentum of as much kinetic energy: sqrt(m I) times the spin."""
    pose, velocity = states(([0, 0, 2], [0] * 6), ([0, 0, 2], [0, 0, -G * DT, 0, 7, 0]))
    found = judge_laws(motion(ball(), pose, velocity))
    only(found, "momentum")
    assert numbers(found)["momentum"] == pytest.approx(7 * MASS * RADIUS * np.sqrt(0.4), rel=EXACT)


def test_an_adhesive_impulse() -> None:
    """The floor slows a ball that leaves it from 1 to 0.5 m/s."""
    found = judged([0, 0, 1, 0, 0, 0], [0, 0, -0.5 * MASS], gravity=0)
    only(found, "adhesion")
    assert found.named is not None
    assert found.named.law == "adhesion"
    assert found.named.violation.number == pytest.approx(0.5 * MASS, rel=EXACT)


def test_friction_outside_the_cone() -> None:
    """By the nearest impulse of the cone, in the metric 1/m along n and 1/m + r^2/I across."""
    mu, across = 0.5, 3.5
    tangential = 0.8 * WEIGHT
    found = judged([1, 0, 0, 0, 0, 0], [-tangential, 0, WEIGHT])
    only(found, "cone")
    assert found.named is not None
    assert found.named.law == "cone"
    normal = (WEIGHT + across * mu * tangential) / (1 + across * mu**2)
    missed = np.hypot(normal - WEIGHT, np.sqrt(across) * (tangential - mu * normal))
    assert found.named.violation.number == pytest.approx(missed, rel=EXACT)


def test_friction_that_drives_what_it_should_slow() -> None:
    """A body that gained energy: friction is in its cone, and along the slip of 1 m/s and more."""
    drive = 0.5 * WEIGHT
    found = judged([1, 0, 0, 0, 0, 0], [drive, 0, WEIGHT])
    only(found, "dissipation", "energy")
    assert found.named is not None
    assert found.named.law == "dissipation"
    slip = 1 + 3.5 * drive / MASS
    assert found.named.violation.number == pytest.approx(2 * drive, rel=EXACT)
    # What the floor takes of the fall of the step counts against it: weight times g dt / 2.
    gained = drive * 0.5 * (1 + slip) - WEIGHT * 0.5 * G * DT
    assert numbers(found)["energy"] == pytest.approx(gained, rel=EXACT)


def test_a_rebound_faster_than_the_fall() -> None:
    """At e = 1/2 a ball that meets the floor with 1 m/s leaves with 0.5: 1.2 is 0.7 m too much."""
    found = judged([0, 0, -1, 0, 0, 0], [0, 0, 2.2 * MASS], gravity=0, e=0.5)
    only(found, "complementarity", "energy")
    assert found.named is not None
    assert (found.named.law, found.named.bodies) == ("complementarity", ("floor", "ball"))
    assert found.named.violation.number == pytest.approx(0.7 * MASS, rel=EXACT)
    gained = 0.5 * MASS * (1.2**2 - 1.0)
    assert numbers(found)["energy"] == pytest.approx(gained, rel=EXACT)


def test_a_body_in_another() -> None:
    """Two balls that stand 10 mm in each other, less what the config leaves alone: 1e-7 m, 1e-9."""
    pose, velocity = np.zeros((2, 2, 7)), np.zeros((2, 2, 6))
    pose[:, :, 3], pose[:, 1, 0] = 1.0, 0.19
    found = judge_laws(motion(BALLS, pose, velocity))
    only(found, "penetration")
    assert found.named is not None
    assert (found.named.law, found.named.bodies) == ("penetration", ("left", "right"))
    assert found.named.violation.number == pytest.approx(0.01, abs=1.1e-7)


def test_a_push_across_a_gap() -> None:
    """A ball that would fall g dt^2 = 1 mm at the most hangs 3 mm above the floor."""
    place = [0.0, 0.0, RADIUS + 0.003]
    pose, velocity = states((place, [0] * 6), (place, [0] * 6))
    found = judge_laws(motion(ball(), pose, velocity))
    only(found, "gap")
    assert found.named is not None
    assert found.named.violation.number == pytest.approx(WEIGHT, rel=EXACT)
    assert found.named.violation.gap == pytest.approx(0.003, rel=1e-9)


def test_of_redundant_impulses_those_cost_nothing_that_the_laws_ask_for() -> None:
    """Slip of 5 m/s at mu = 0.5: 1 N s of friction against it takes what slip requires."""
    contacts = SimpleNamespace(
        mu=np.array([0.5]), restitution=np.array([0.5]), rigid=np.array([True])
    )
    points = SimpleNamespace(
        contacts=contacts, after=np.array([[1.0, 3.0, 4.0]]), approach=np.array([2.0])
    )
    (cost,) = _cost(points)
    assert cost @ [2.0, -0.6, -0.8] == pytest.approx(0.0, abs=EXACT)
    assert cost @ [2.0, 0.0, 0.0] == 5.0  # 2 N s at 0.5 of 5 m/s that friction does not take
    points.after[0, 0] = 1.25  # parts faster than e times the approach, and is pushed
    (faster,) = _cost(points)
    assert faster @ [2.0, -0.6, -0.8] == pytest.approx(0.5, abs=EXACT)
