"""Unions of bodies by springs and pushing contacts: who is in one, and how it is moved."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from interpreted import Rows, interpreted

from lavendersim.engine.effects.spring import make_place
from lavendersim.engine.spec import Spec
from lavendersim.engine.spring_turn import BOTH
from lavendersim.engine.spring_unions import make_unions

SPEC = Spec(effects=("spring", "contact_midpoint"))
UNIONS = make_unions(SPEC, make_place(SPEC))
JOIN, PUT, PULL = (interpreted(one) for one in (UNIONS.join, UNIONS.put, UNIONS.pull))
PART = interpreted(UNIONS.part)
SHIFT = ("shift_x", "shift_y", "shift_z")
BODY = np.dtype([("inv_m", "f8"), *((n, "f8") for n in SHIFT), ("group", "i8"), ("again", "i8"), ("sprung", "i8")])  # noqa: E501  # fmt: skip
LINK = np.dtype([("a", "i8"), ("b", "i8"), ("active", "i8"), ("again", "i8")])
CONTACT = np.dtype([("a", "i8"), ("b", "i8"), ("lambda_n", "f8")])
VELOCITY = np.dtype([(f"v{axis}", "f8") for axis in "xyz"])


def bodies(*inverse_masses: float) -> Rows:
    rows = np.zeros(len(inverse_masses), BODY)
    rows["inv_m"] = inverse_masses
    return Rows(rows)


def table(dtype: np.dtype, *rows: tuple) -> Rows:
    return Rows(np.array([*rows], dtype))


def joined(rows: Rows, links: Rows, contacts: Rows) -> tuple[int, list[int]]:
    """How many springs unions have, and which bodies are in one."""
    found = JOIN(links, rows, contacts, len(contacts), True)
    return found, np.flatnonzero(rows.array["again"] == 1).tolist()


def test_a_union_is_what_a_chain_of_springs_and_pushes_reaches() -> None:
    """1-2 by a spring, 2-3 pushed, 3-4 by a spring, 5-6 by a spring alone; 0 is a floor."""
    rows = bodies(0.0, *[1.0] * 6)
    links = table(LINK, (1, 2, 1, 0), (3, 4, 1, 0), (5, 6, 1, 0))
    contacts = table(CONTACT, (2, 3, 0.5), (4, 5, 0.0))
    assert joined(rows, links, contacts) == (2, [1, 2, 3, 4])
    assert links.array["again"].tolist() == [1, 1, 0]


def test_a_floor_joins_nobody() -> None:
    """Two bodies on one floor, each with a spring to it; only one is pushed."""
    rows = bodies(0.0, 1.0, 1.0)
    links = table(LINK, (0, 1, 1, 0), (0, 2, 1, 0))
    assert joined(rows, links, table(CONTACT, (0, 2, 1.0))) == (1, [2])


@pytest.mark.parametrize(("active", "push"), [(0, 1.0), (1, 0.0)])
def test_without_a_spring_at_work_or_a_push_there_is_none(active: int, push: float) -> None:
    rows, links = bodies(0.0, 1.0), table(LINK, (0, 1, active, 0))
    assert joined(rows, links, table(CONTACT, (0, 1, push))) == (0, [])


def moved(floor: bool, share: float) -> np.ndarray:
    """How far two bodies of 1 and 3 kg, a spring between them, are moved in 0.1 s."""
    rows = bodies(0.0, 1.0, 1.0 / 3.0)
    links = table(LINK, (1, 2, 1, 0))
    contacts = table(CONTACT, (0, 1, 1.0), (1, 2, 1.0)) if floor else table(CONTACT, (1, 2, 1.0))
    JOIN(links, rows, contacts, len(contacts), True)
    motion = table(VELOCITY, (0, 0, 0), (4.0, 0, 0), (0.0, 0, 0))
    velocities = table(VELOCITY, (0, 0, 0), (0.0, 0, 2.0), (0.0, 4.0, 2.0))
    state = SimpleNamespace(links=links, contacts=contacts, velocities=velocities, motion=motion)
    PUT(state, rows, len(contacts), share, 0.1)
    assert (rows.array["sprung"][1:] == BOTH).all()
    return np.column_stack([rows.array[name] for name in SHIFT])[1:]


def test_a_free_union_goes_on_with_its_centre_and_a_share_of_what_is_beside_it() -> None:
    """Centre: (1, 0, 0) before, (0, 3, 2) after; the mean of both, whatever the share."""
    assert moved(False, 0.0) == pytest.approx(np.array([[0.05, 0.15, 0.1]] * 2), abs=1e-15)
    beside = np.array([[0.0, -3.0, 0.0], [0.0, 1.0, 0.0]])
    assert moved(False, 0.5) - moved(False, 0.0) == pytest.approx(0.05 * beside, abs=1e-15)


def test_a_union_on_the_floor_is_moved_by_a_share_of_its_velocities() -> None:
    assert moved(True, 0.0) == pytest.approx(0.0, abs=0.0)
    after = np.array([[0.0, 0.0, 2.0], [0.0, 4.0, 2.0]])
    assert moved(True, 0.25) == pytest.approx(0.025 * after, rel=1e-15)


@pytest.mark.parametrize(("floor", "centre"), [(False, -7.0), (True, 0.0)])
def test_forces_change_the_velocity_of_a_centre_that_nothing_holds(
    floor: bool, centre: float
) -> None:
    """Of 1 and 3 kg that forces make faster by -4 and -8 m/s: (1 * -4 + 3 * -8) / 4."""
    rows = pulled(0.0, 1.0, 1.0 / 3.0)
    rows.array["pulled_z"] = 0.0, -4.0, -8.0
    links, contacts = table(LINK, (1, 2, 1, 0)), table(CONTACT, (0, 1, 1.0), (1, 2, 1.0))
    count = 2 if floor else 1
    contacts = contacts if floor else table(CONTACT, (1, 2, 1.0))
    JOIN(links, rows, contacts, count, True)
    PULL(links, contacts, rows, count)
    assert rows.array["push_z"][1:] == pytest.approx([centre, centre], rel=1e-15)


def pulled(*inverse_masses: float) -> Rows:
    names = [f"{kind}_{axis}" for kind in ("pulled", "push") for axis in "xyz"]
    rows = np.zeros(len(inverse_masses), [*BODY.descr, *((name, "f8") for name in names)])
    rows["inv_m"] = inverse_masses
    return Rows(rows)


def test_what_is_held_and_not_moved_slows_down() -> None:
    """Else it would stand in each step as in the one before."""
    rows, links = bodies(0.0, 1.0), table(LINK, (0, 1, 1, 0))
    contacts = table(CONTACT, (0, 1, 1.0))
    JOIN(links, rows, contacts, 1, True)
    velocities = table(VELOCITY, (0, 0, 0), (0.0, 4.0, 2.0))
    motion = table(VELOCITY, (0, 0, 0), (0.0, 0, 0))
    state = SimpleNamespace(links=links, contacts=contacts, velocities=velocities, motion=motion)
    PUT(state, rows, 1, 0.5, 0.1)
    assert velocities.array["vy"][1] == 4.0
    PUT(state, rows, 1, 0.0, 0.1)
    assert 0.0 < velocities.array["vy"][1] < 4.0


AIM = ("to_vx", "to_vy", "to_vz", "pulled_x", "pulled_y", "pulled_z")


@pytest.mark.parametrize("again", [0, 1])
def test_what_no_contact_joins_to_a_spring_any_more_has_all_its_forces(again: int) -> None:
    """2 and 3 push each other, 1 has a spring to the floor; all were placed, by no force at all."""
    rows = Rows(np.zeros(4, np.dtype([*BODY.descr, ("placed", "i8"), *((n, "f8") for n in AIM)])))
    rows.array["inv_m"][1:], rows.array["placed"][1:] = 1.0, 1
    rows.array["again"][1:], rows.array["sprung"][1:] = again, BOTH
    rows.array["pulled_z"][1:] = -0.5
    motion = table(VELOCITY, *[(3.0, 2.0, 1.0)] * 4)
    links = table(LINK, (0, 1, 1, 0))
    contacts = table(CONTACT, (1, 2, 0.0), (2, 3, 1.0), (0, 1, 1.0))
    JOIN(links, rows, contacts, len(contacts), False)
    assert PART(links, rows, motion)
    aims = np.column_stack([rows.array[name] for name in AIM[:3]])
    assert aims.tolist() == [[0.0] * 3, [0.0] * 3, [3.0, 2.0, 0.5], [3.0, 2.0, 0.5]]
    assert rows.array["again"].tolist() == [0, 1, 0, 0]
    assert rows.array["sprung"].tolist() == [0, BOTH, 0, 0]
    assert not PART(links, rows, motion)
