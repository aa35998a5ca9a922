"""Packed contacts and bodies have what dense algebra has, and groups of eight share no body.

Numbers are put and taken by plain functions here; `test_lane_memory` has the primitives.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from drawn_contacts import Drawn, drawn, stacked, views
from interpreted import interpreted, records

from lavendersim.engine.solvers.packed import packing
from lavendersim.engine.solvers.packed.lane_memory import STRIDE
from lavendersim.engine.solvers.packed.lanes import WIDTH
from lavendersim.engine.solvers.packed.layout import HEAD, PackedContacts, allocate_packed
from lavendersim.engine.solvers.solver import ContactSystem
from lavendersim.engine.spec import Spec

FRICTIONAL = Spec(effects=("contact_torque", "friction", "rotation"))
FRICTIONLESS = Spec(effects=("contact_torque", "rotation"))
# Eleven contacts that no eight of share no body, four far ones; the floor is everybody's.
PAIRS = [
    *[(0, 1), (0, 2), (3, 4), (5, 0), (1, 2), (6, 0), (7, 8), (8, 0), (9, 0), (0, 10), (3, 0)],
    *[(0, 11), (12, 0), (13, 14), (0, 15)],
]
EIGHTS = pytest.mark.parametrize("eight", [False, True], ids=["singly", "eights"])


@pytest.fixture(autouse=True)
def plain_places(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(packing, "put_one", lambda rows, at, value: rows.__setitem__(at, value))
    monkeypatch.setattr(packing, "take_one", lambda rows, at: rows[at])
    monkeypatch.setattr(packing, "make_prefetch_span", lambda names: lambda records, at: None)
    monkeypatch.setattr(packing, "prefetch_impulses", lambda records, at: None)


def system_of(scene: Drawn, order: np.ndarray) -> ContactSystem:
    bodies, velocities, contacts = views(scene)
    return ContactSystem(contacts, order, len(order), bodies, velocities)


def fields_of_levers(spec: Spec, eight: bool) -> tuple[Callable[..., Any], int]:
    """Return a kernel that packs the arms of a normal alone, and their count."""
    step = WIDTH if eight else 1
    put_arms = packing.make_put_arms(spec, eight)

    def pack_contact(contact, velocities, rows, at, factor):
        put_arms(contact, factor, rows, at, at + 3 * step)

    return packing.kernel(pack_contact, spec), 6


def packed(
    scene: Drawn, spec: Spec, eight: bool, order: np.ndarray
) -> tuple[ContactSystem, PackedContacts, int]:
    """Return what is packed of contacts of six fields, and how many slots it takes."""
    pack_contact, fields = fields_of_levers(spec, eight)
    pack = interpreted(packing.make_pack_rows(spec, eight, pack_contact, fields))
    memory = allocate_packed(spec, len(scene.bodies), len(order), eight)
    memory.rows[:] = np.nan  # of a solve before
    memory.state[:] = np.nan
    system = system_of(scene, order)
    return system, memory, pack(system, records(memory))


def factor_of(memory: PackedContacts, i: int) -> np.ndarray:
    own = memory.factor[i]
    return np.array(
        [[own["xx"], 0.0, 0.0], [own["yx"], own["yy"], 0.0], [own["zx"], own["zy"], own["zz"]]]
    )


@pytest.mark.parametrize("spec", [FRICTIONAL, FRICTIONLESS], ids=["friction", "frictionless"])
def test_factors_are_those_of_the_inverse_inertia(spec: Spec, rng) -> None:
    scene = drawn(spec, rng, PAIRS)
    _, memory, _ = packed(scene, spec, False, np.arange(len(PAIRS)))
    for i in range(len(scene.bodies)):
        inverse = scene.inverse[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6]
        factor = factor_of(memory, i)
        np.testing.assert_allclose(factor @ factor.T, inverse, atol=1e-14)
        assert (np.diag(factor) >= 0.0).all()
    assert not factor_of(memory, 0).any()
    state = memory.state[STRIDE * HEAD :]
    assert len(state) == STRIDE * len(scene.bodies)
    assert not state.any()  # nothing has changed yet
    assert not memory.state[:STRIDE].any()  # nor what nothing moves


@EIGHTS
@pytest.mark.parametrize("spec", [FRICTIONAL, FRICTIONLESS], ids=["friction", "frictionless"])
def test_arms_turn_bodies_as_impulses_along_normals_do(spec: Spec, eight: bool, rng) -> None:
    """y += arm lambda, omega = omega_0 + L y: together I^-1 (r x n) lambda, - on A and + on B."""
    scene = drawn(spec, rng, PAIRS)
    order = rng.permutation(len(PAIRS))
    _, memory, _ = packed(scene, spec, eight, order)
    place = interpreted(packing.make_place(spec, eight, 6))
    step = WIDTH if eight else 1
    for k, c in enumerate(order):
        at = place(memory.slot[k])
        response = scene.inverse @ scene.jacobian[3 * c]
        for side, i in enumerate(PAIRS[c]):
            arm = memory.rows[at + 3 * side * step : at + 3 * (side + 1) * step : step]
            expected = response[6 * i + 3 : 6 * i + 6]
            np.testing.assert_allclose(factor_of(memory, i) @ arm, expected, atol=1e-14)


def test_a_block_turns_by_all_its_axes(rng) -> None:
    scene = drawn(FRICTIONAL, rng, [(1, 2)])
    _, memory, _ = packed(scene, FRICTIONAL, False, np.arange(1))
    _, _, put_turns = packing.make_put_geometry(FRICTIONAL, True)
    row, rows = scene.contacts[0], np.zeros(9 * WIDTH)
    for side, i, name in ((-1.0, 1, "ra"), (1.0, 2, "rb")):
        r = records(scene.contacts)[0]
        lever = packing.Vec3(*(row[f"{name}{axis}"] for axis in "xyz"))
        interpreted(put_turns)(rows, 3, records(memory.factor)[i], side, r, lever)
        turns = rows[3::WIDTH].reshape(3, 3) @ factor_of(memory, i).T
        response = scene.jacobian @ scene.inverse
        np.testing.assert_allclose(turns, response[:, 6 * i + 3 : 6 * i + 6], atol=1e-14)
    put = interpreted(packing.make_put(FRICTIONAL, True))
    put(rows, 3, 5, 0.25)
    assert rows[3 + 5 * WIDTH] == 0.25


@pytest.mark.parametrize("run", [1, 2, 64])
def test_no_movable_body_reaches_further_than_is_said(
    run: int, rng, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(packing, "RUN", run)
    scene = drawn(FRICTIONAL, rng, PAIRS)
    for order in (np.arange(len(PAIRS)), rng.permutation(len(PAIRS))):
        _, memory, _ = packed(scene, FRICTIONAL, True, order)
        runs: dict[int, list[int]] = {}
        for k, c in enumerate(order):
            for i in PAIRS[c]:
                if i != 0:  # the floor
                    runs.setdefault(i, []).append(int(memory.slot[k]) // WIDTH // run)
        assert memory.reach[0] == max(max(own) - min(own) for own in runs.values())


def test_a_group_has_no_movable_body_twice_and_is_filled_with_nothing(rng) -> None:
    scene = drawn(FRICTIONAL, rng, PAIRS)
    order = rng.permutation(len(PAIRS))
    _, memory, slots = packed(scene, FRICTIONAL, True, order)
    used = memory.slot[: len(order)]
    assert (np.diff(used) > 0).all()
    assert slots == WIDTH * (used[-1] // WIDTH + 1)
    place = interpreted(packing.make_place(FRICTIONAL, True, 6))
    previous = [0] * WIDTH
    for group in range(slots // WIDTH):
        own = [int(order[k]) for k in range(len(order)) if used[k] // WIDTH == group]
        movable = [i for c in own for i in PAIRS[c] if i != 0]
        assert len(set(movable)) == len(movable)
        if group:  # it began since its first contact shares a body with the group before
            before = {i for c in previous for i in PAIRS[c] if i != 0}
            assert len(previous) == WIDTH or before & set(PAIRS[own[0]])
        previous = own
    assert len({int(k) // WIDTH for k in used}) > 1
    for slot in range(slots):
        begins = memory.first[slot], memory.second[slot]
        if slot in used:
            c = order[list(used).index(slot)]
            # the floor is body 0, and what nothing moves is read from the first line
            assert begins == tuple(STRIDE * (HEAD + i) if i else 0 for i in PAIRS[c])
        else:
            assert begins == (0, 0)
            fields = memory.rows[place(slot) : place(slot) + 6 * WIDTH : WIDTH]
            np.testing.assert_array_equal(fields, 0.0)


@EIGHTS
def test_bodies_leave_with_what_the_state_says_and_contacts_with_their_own_rows(
    eight: bool, rng
) -> None:
    scene = drawn(FRICTIONAL, rng, PAIRS)
    order = rng.permutation(len(PAIRS))
    system, memory, _ = packed(scene, FRICTIONAL, eight, order)
    before, change = stacked(scene.velocities), rng.normal(size=(len(scene.bodies), STRIDE))
    memory.state[HEAD * STRIDE :] = change.ravel()
    place = interpreted(packing.make_place(FRICTIONAL, eight, 6))
    for k, c in enumerate(order):
        memory.rows[place(memory.slot[k])] = 10.0 + c

    def unpack_contact(contact, rows, at):
        contact.lambda_n = rows[at]

    kernel = packing.kernel(unpack_contact, FRICTIONAL)
    interpreted(packing.make_unpack_rows(FRICTIONAL, eight, kernel, 6))(system, records(memory))
    np.testing.assert_array_equal(scene.contacts["lambda_n"], 10.0 + np.arange(len(PAIRS)))
    expected = before.reshape(-1, 6)
    expected[1:, :3] += change[1:, :3]
    for i in range(1, len(expected)):
        expected[i, 3:] += factor_of(memory, i) @ change[i, 4:7]
    np.testing.assert_allclose(stacked(scene.velocities).reshape(-1, 6), expected, atol=1e-14)
