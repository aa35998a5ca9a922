"""Friction at the middle does no work on the slip of the start: a row then slides in the mean."""

from __future__ import annotations

import numpy as np
from drawn_contacts import drawn, put_vector
from interpreted import interpreted, records

from lavendersim.engine import midpoint_rows
from lavendersim.engine.midpoint_rows import SAME
from lavendersim.engine.spec import Spec

EFFECTS = ("contact_midpoint", "friction", "impact_order", "impact_time", "rotation")
SPEC = Spec(EFFECTS, ("sphere_plane", "sphere_sphere"))
STRAIGHT = SPEC.without("friction", "rotation")
RESIST = interpreted(midpoint_rows.make_resist(SPEC))


def resists(begin: tuple[float, float], slip: tuple[float, float], **values: float) -> bool:
    """Whether a contact that begins and ends with these slips counts the first, by its friction."""
    scene = drawn(SPEC, np.random.default_rng(6), [(0, 1)], fixed=())
    contact, row = records(scene.contacts)[0], scene.contacts[0]
    contact.surface_1 = contact.surface_2 = 0.0
    contact.lasts, contact.slides, contact.lambda_n = 1, 0, 1.0
    for name, value in values.items():
        contact[name] = value
    frame = [np.array([row[f"{t}{x}"] for x in "xyz"]) for t in ("t1", "t2")]
    put_vector(row, "begin_", begin[0] * frame[0] + begin[1] * frame[1])
    for own, v in zip(
        scene.velocities,
        (np.linalg.pinv(scene.jacobian) @ (0.0, *slip)).reshape(-1, 6),
        strict=True,
    ):
        put_vector(own, "v", v[:3])
        put_vector(own, "w", v[3:])
    before = contact.slides
    more = bool(RESIST(records(scene.contacts), 1, records(scene.velocities)))
    assert contact.slides == (1 if more else before)
    return more


def test_friction_that_has_turned_since_the_start_does_no_work_on_the_mean_slip() -> None:
    """Its work is lambda_t . (w + s_0)/2; w is what the row leaves, 0 where it sticks."""
    assert resists((0.1, 0.0), (0.0, 0.0), lambda_1=0.2, lambda_2=5.0)
    assert not resists((0.1, 0.0), (0.0, 0.0), lambda_1=-0.2, lambda_2=5.0)
    # What slides at the end gives back as much as it is given, or more.
    for share in (1.0 - 1e-6, 1.0 + 1e-6):
        found = resists((0.1, 0.0), (-0.1 * share, 0.0), lambda_1=0.2, lambda_2=0.0)
        assert found == (share < 1.0)
    # Below what solves leave of a velocity it is no work.
    assert not resists((0.9 * SAME, 0.0), (0.0, 0.0), lambda_1=1.0, lambda_2=0.0)
    assert resists((1.1 * SAME, 0.0), (0.0, 0.0), lambda_1=1.0, lambda_2=0.0)


def test_what_does_not_last_or_push_or_slides_already_has_no_slip_to_count() -> None:
    for values in ({"lasts": 0}, {"lambda_n": 0.0}, {"slides": 2}, {"slides": 1}):
        assert not resists((0.1, 0.0), (0.0, 0.0), lambda_1=0.2, lambda_2=0.0, **values)
    assert midpoint_rows.make_resist(STRAIGHT) is None


def test_the_slip_of_what_is_driven_counts_for_nothing() -> None:
    """A table that is moved does work on what rides on it; a floor that stands does none."""
    for side, other in ("ab", "ba"):
        driven = {f"inv_m_{side}": 0.0, f"inv_m_{other}": 1.0}
        assert not resists((0.1, 0.0), (0.01, 0.0), lambda_1=0.2, lambda_2=0.0, **driven)
        assert resists((0.1, 0.0), (0.0, 0.0), lambda_1=0.2, lambda_2=0.0, **driven)  # all stands
