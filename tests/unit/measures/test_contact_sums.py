"""Sums over the contacts of a step, row by row in plain Python; a falsified number is seen."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from random_contacts import FORMS, STEPS, section

from lavendersim.measures.contact_sums import ContactSums, excesses, summed
from lavendersim.measures.sections import Section


def sums_of(part: Section) -> ContactSums:
    with np.errstate(all="ignore"):
        return summed(part)


def test_sums_of_a_step_are_those_of_its_rows() -> None:
    """Row by row in plain Python, of one step at a time."""
    part = section(FORMS["spins"], "disc", 0.0)
    sums, contact = sums_of(part), part.contact
    beyond = excesses(part, contact)
    for step in range(STEPS):
        mine = np.flatnonzero(contact["step"] == step)
        pushed = [abs(contact["impulse_n"][c]) for c in mine]
        worst = max([0.0, *(beyond[c] for c in mine)])
        assert sums.excess[step] == (worst / max(pushed) if worst else 0.0)
        assert sums.deepest[step] == max([0.0, *(contact["penetration"][c] for c in mine)])
        assert sums.not_finite[step] == 0.0
        # Five contacts of some ten operations: 50 round-offs of 1.1e-16 of their size, 6e-15.
        scale = 1e-14 * (sums.size[step] + 1e-300)
        for axis, total in zip("xyz", sums.outer[step], strict=True):
            expected = sum(_outer(contact[c], axis) for c in mine)
            assert abs(total - expected) <= scale


def _outer(row: Any, axis: str) -> float:
    """Return what a contact gives to everything movable along an axis; the floor is fixed."""
    movable = (0.0, 1.0, 1.0, 1.0)
    sign = movable[row["body_b"]] - movable[row["body_a"]]
    n, t1 = ([row[f"{name}{a}"] for a in "xyz"] for name in ("n", "t1"))
    k = "xyz".index(axis)
    t2 = n[(k + 1) % 3] * t1[(k + 2) % 3] - n[(k + 2) % 3] * t1[(k + 1) % 3]
    total = n[k] * row["impulse_n"] + t1[k] * row["impulse_t1"] + t2 * row["impulse_t2"]
    return float(sign * total)


@pytest.mark.parametrize(
    ("column", "number", "field"),
    [
        ("impulse_n", -3.0, "excess"),
        ("impulse_t1", 1e3, "excess"),
        ("angular_impulse_n", -1e3, "excess"),
        ("angular_impulse_t2", 1e3, "excess"),
        ("penetration", 7.0, "deepest"),
        ("nx", np.nan, "not_finite"),
    ],
)
def test_one_falsified_number_is_seen_in_its_step_alone(
    column: str, number: float, field: str
) -> None:
    part = section(FORMS["spins"], "disc", 0.0)
    # What keeps every limit: no impulse but a push.
    for name in ("impulse_t1", "impulse_t2", "angular_impulse_n", "angular_impulse_t1"):
        part.contact[name] = 0.0
    part.contact["angular_impulse_t2"], part.contact["penetration"] = 0.0, 0.0
    part.contact["impulse_n"] = 1.0
    for name in ("friction", "torsional_friction", "rolling_friction"):
        part.contact[name] = 0.01
    part.contact["joint"] = 0
    before = getattr(sums_of(part), field).copy()
    assert not before.any()
    part.contact[column][7] = number
    changed = np.flatnonzero(getattr(sums_of(part), field))
    assert changed.tolist() == [part.contact["step"][7]]


def test_impulse_of_a_joint_has_either_sign() -> None:
    part = section(FORMS["frictionless"], "disc", 0.0)
    part.contact["impulse_n"], part.contact["joint"] = -3.0, 1
    assert not sums_of(part).excess.any()
    part.contact["joint"] = 0
    assert (sums_of(part).excess > 0.0).sum() == len(np.unique(part.contact["step"]))


def test_a_contact_at_the_middle_opens_by_its_mean_and_not_by_where_it_ends() -> None:
    """J (v_0 + v_1)/2 = (v_n + target)/2 of what pushes; the projection opens what it leaves deep.

    A rim that rolls up at V was as deep all the while, though d - V dt is above the surface.
    """
    part = section(FORMS["spins"], "disc", 0.0, integrator="midpoint_contact")
    numerics, contact = part.config.numerics, part.contact
    deep, rises = numerics.slop + 1e-4, 50.0
    contact["separation"], contact["normal_velocity"] = -deep, rises
    contact["target"], contact["impulse_n"] = -rises, 1.0
    count = np.bincount(contact["step"], minlength=STEPS)
    np.testing.assert_allclose(sums_of(part).opened, numerics.projection * 1e-4 * count, rtol=1e-11)
    # What only passes by ends where its velocity leads.
    contact["impulse_n"] = 0.0
    assert not sums_of(part).opened.any()
    # And what ends nearer than its mean is as deep as it ends.
    contact["impulse_n"], contact["target"] = 1.0, 3.0 * rises
    contact["normal_velocity"] = 0.0
    np.testing.assert_allclose(sums_of(part).opened, numerics.projection * 1e-4 * count, rtol=1e-11)
