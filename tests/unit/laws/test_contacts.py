"""Contacts of poses, with what their pairs obey; configs that poses and velocities do not tell."""

from __future__ import annotations

import numpy as np
import pytest
from made_motion import BALLS, DT, RADIUS, ball, motion, states

from lavendersim.errors import UsageError
from lavendersim.laws.contacts import AROUND, ContactSearch

SLOW = np.zeros((2, 2))


def search(text: str) -> ContactSearch:
    return ContactSearch(motion(text, *states(([0, 0, RADIUS], [0] * 6))))


def pose(height: float) -> np.ndarray:
    return states(([0.3, 0.2, height], [0] * 6))[0][0]


def test_levers_end_on_each_bodys_own_surface() -> None:
    found = search(ball()).at(pose(RADIUS + 0.004), SLOW, DT)
    assert found.gap == pytest.approx([0.004], abs=1e-16)
    assert found.lever_b[0] == pytest.approx([0, 0, -RADIUS], abs=1e-16)
    assert found.lever_a[0] == pytest.approx([0.3, 0.2, 0.0], abs=1e-16)
    assert np.linalg.det(found.frame[0]) == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize(("law", "indented"), [("spring", 0.002), ("regularised", 0.0)])
def test_levers_of_what_moves_and_gives_way_end_at_one_point(law: str, indented: float) -> None:
    """In the middle, by the law of springs: as friction acts there, it turns both alike."""
    soft = "surface: {friction: 0.5, compliance: 1e-5}, mass: 2"
    text = BALLS.replace("mass: 2", soft)
    text = text.replace("timestep: 1/100", f"timestep: 1/100, compliance_law: {law}")
    place = states(([2 * RADIUS - 0.004, 0, 0], [0] * 6))
    found = ContactSearch(motion(text, *place)).at(place[0][0], SLOW, DT)
    assert found.gap == pytest.approx([-0.004], abs=1e-16)
    assert found.lever_a[0] == pytest.approx([RADIUS - indented, 0, 0], abs=1e-16)
    assert found.lever_b[0] == pytest.approx([indented - RADIUS, 0, 0], abs=1e-16)


def test_it_looks_as_far_as_bodies_get_and_a_little_around() -> None:
    near = ContactSearch.at
    one = search(ball())
    limit = AROUND * RADIUS
    assert len(near(one, pose(RADIUS + 0.99 * limit), SLOW, DT).gap) == 1
    assert len(near(one, pose(RADIUS + 1.01 * limit), SLOW, DT).gap) == 0
    fast = np.array([[0.0, 0.0], [2.0, 0.0]])  # 2 m/s: 20 mm in the step
    assert len(near(one, pose(RADIUS + 1.01 * limit), fast, DT).gap) == 1


def test_pairs_obey_what_their_surfaces_mix_to() -> None:
    first, second = ball(e=0.25).split("    ball:")
    text = f"{first}    ball:{second.replace('friction: 0.5', 'friction: 0.02')}"
    found = search(text).at(pose(RADIUS), SLOW, DT)
    assert found.mu == pytest.approx([np.sqrt(0.5 * 0.02)])
    assert found.restitution.tolist() == [0.25]
    assert found.rigid.tolist() == [True]


def test_static_friction_is_the_limit_where_it_is_the_larger() -> None:
    surface = "friction: 0.5, static_friction: 0.8, stribeck_velocity: 0.01, restitution: 0.0"
    found = search(ball(e=0.0).replace("friction: 0.5, restitution: 0.0", surface))
    assert found.at(pose(RADIUS), SLOW, DT).mu == pytest.approx([0.8])


def test_events_change_masses_and_gravity() -> None:
    events = "events:\n  - {at: 0, body: ball, scale_mass: 3}\n  - {at: 0.5, gravity: [1, 0, 0]}\n"
    one = search(ball() + events)
    assert one.masses.tolist() == [0.0, 2.0]
    one.begin(0)
    assert one.masses == pytest.approx([0.0, 6.0])
    assert one.moments[1] == pytest.approx([0.4 * 6 * RADIUS**2] * 3)
    assert one.gravity.tolist() == [0, 0, -10]
    one.begin(50)
    assert one.gravity.tolist() == [1, 0, 0]


def test_what_poses_and_velocities_do_not_tell_is_refused() -> None:
    text = ball().replace("mass: 2\n", "mass: 2\n      drag: {linear: 0.1}\n")
    with pytest.raises(UsageError, match=r"made\.mcap: drag \(ball.*no step is judged"):
        search(text)


def test_events_that_a_state_makes_happen_are_refused() -> None:
    event = "{when: {body: ball, below: 0}, body: ball, velocity: [0, 0, 1]}"
    with pytest.raises(UsageError, match=r"when ball is below 0 m .*no step is judged"):
        search(ball() + f"events: [{event}]\n")
