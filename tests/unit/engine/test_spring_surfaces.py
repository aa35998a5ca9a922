"""Which unions have surfaces that do work on them: those that push or tie them, no others."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from interpreted import Rows, interpreted

from lavendersim.engine.effects.spring import make_place
from lavendersim.engine.spec import Spec
from lavendersim.engine.spring_surfaces import make_note_working, make_stored_in_contacts
from lavendersim.engine.spring_unions import make_unions

SPEC = Spec(effects=("spring", "contact_midpoint", "kinematic", "compliance", "surface_velocity"))
NOTE = interpreted(make_note_working(SPEC))
JOIN = interpreted(make_unions(SPEC, make_place(SPEC)).join)
BODY = [("inv_m", "f8"), *((f"s{axis}", "f8") for axis in "xyz")]
BODY += [(name, "i8") for name in ("kinematic", "group", "again", "worked")]
VELOCITY = [(f"v{axis}", "f8") for axis in "xyz"]
LINK = [("a", "i8"), ("b", "i8"), ("active", "i8"), ("again", "i8")]
CONTACT = [("a", "i8"), ("b", "i8"), ("pair", "i8"), ("lambda_n", "f8")]
FLOOR, LIFT, ONE, TWO = range(4)  # two bodies, each a union with the floor that a spring ties it to


def noted(
    contacts: list[tuple[int, int, int, float]],
    *,
    lifts: float = 0.0,
    belt: int | None = None,
    tied: int = FLOOR,
) -> tuple[bool, list[int]]:
    """Whether any union is worked on, and which; pair 1 of two is the one that gives way."""
    rows = np.zeros(4, BODY)
    rows["inv_m"] = 0.0, 0.0, 1.0, 1.0
    rows["kinematic"][LIFT] = 1
    if belt is not None:
        rows["sx"][belt] = 1.0
    velocities = np.zeros(4, VELOCITY)
    velocities["vz"][LIFT] = lifts
    pairs = np.zeros(2, [("compliance", "f8")])
    pairs["compliance"][1] = 1e-6
    links = Rows(np.array([(tied, ONE, 1, 0), (FLOOR, TWO, 1, 0)], LINK))
    state: Any = SimpleNamespace(
        links=links,
        contacts=Rows(np.array(contacts, CONTACT)),
        velocities=Rows(velocities),
        pairs=Rows(pairs),
    )
    bodies = Rows(rows)
    JOIN(links, bodies, state.contacts, len(contacts), True)
    found = NOTE(state, bodies, len(contacts))
    return found, np.flatnonzero(rows["worked"]).tolist()


BOTH_PRESSED = [(FLOOR, ONE, 0, 1.0), (FLOOR, TWO, 0, 1.0)]


def test_nothing_works_on_bodies_that_a_rigid_floor_pushes() -> None:
    assert noted(BOTH_PRESSED) == (False, [])


@pytest.mark.parametrize(("push", "expected"), [(1.0, (True, [ONE])), (0.0, (False, []))])
def test_a_contact_that_gives_way_tells_of_its_union_where_it_pushes(
    push: float, expected: tuple[bool, list[int]]
) -> None:
    assert noted([*BOTH_PRESSED, (FLOOR, ONE, 1, push)]) == expected


@pytest.mark.parametrize(("lifts", "expected"), [(1.0, (True, [TWO])), (0.0, (False, []))])
def test_a_kinematic_body_works_where_it_pushes_and_moves(
    lifts: float, expected: tuple[bool, list[int]]
) -> None:
    assert noted([*BOTH_PRESSED, (LIFT, TWO, 0, 1.0)], lifts=lifts) == expected


def test_a_kinematic_body_works_on_what_a_spring_ties_to_it() -> None:
    assert noted(BOTH_PRESSED, lifts=1.0, tied=LIFT) == (True, [ONE])
    assert noted([(FLOOR, TWO, 0, 1.0)], lifts=1.0, tied=LIFT) == (False, [])  # no contact pushes


def test_a_belt_works_on_what_stands_on_it_alone() -> None:
    assert noted([(LIFT, ONE, 0, 1.0), (FLOOR, TWO, 0, 1.0)], belt=LIFT) == (True, [ONE])


@pytest.mark.parametrize("worked", [0, 1])
def test_a_contact_spring_stores_half_its_stretch_squared_by_its_compliance(worked: int) -> None:
    """2 mm deep, 1 mm deeper, c = 1e-4 m/N; of a union that a belt works on nothing counts."""
    spec = Spec(effects=("spring", "contact_midpoint", "compliance", "contact_spring"))
    stored = interpreted(make_stored_in_contacts(spec))
    rows = np.zeros(2, [("group", "i8"), ("again", "i8"), ("worked", "i8")])
    rows[1] = 2, 1, worked
    row = [("a", "i8"), ("b", "i8"), *((f"n{axis}", "f8") for axis in "xyz"), ("phi", "f8")]
    contacts = np.zeros(1, [*row, ("spring_compliance", "f8"), ("lambda_n", "f8")])
    contacts[0] = 0, 1, 0.0, 0.0, 1.0, -2e-3, 1e-4, 1.0
    shifts = np.zeros(2, VELOCITY)
    shifts["vz"][1] = -1e-3
    before, after = 0.5 * (2e-3) ** 2 / 1e-4, 0.5 * (3e-3) ** 2 / 1e-4
    won, had = stored(Rows(contacts), 1, Rows(rows), Rows(shifts))
    expected = (0.0, 0.0) if worked else (after - before, before)
    assert (won, had) == pytest.approx(expected, rel=1e-12)
