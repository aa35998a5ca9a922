"""Packed sweeps are the sweeps of projected Gauss-Seidel: to round-off, and eight at a time to the
bit; what they leave obeys mechanics worked out without them.
"""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import EVERYTHING
from packed_scenes import BLOCKS, SCENES, found, mechanics, natural_maps

from lavendersim.engine.solvers.catalogue import SOLVERS
from lavendersim.engine.solvers.packed.lanes import WIDTH
from lavendersim.engine.solvers.packed.layout import BLOCK, INV_K, K_N, W_N
from lavendersim.engine.solvers.packed.sweep import can_pack
from tests.benchmarks.prepared_contacts import Solve

PACKED = ("block_gauss_seidel", "coloured_gauss_seidel")
# Velocities of some m/s, a hundred roundings of 2^-53 a visit, and as many visits as pass errors
# on: contacts of a tower, times sweeps. Sweeps do not enlarge errors; they may add up.
ROUND_OFF = 2.0**-53 * 100 * 100
SPEED = 5.0  # [m/s] nothing in the scenes is faster


def left(solve: Solve) -> bytes:
    return solve.impulses.tobytes() + solve.velocities.tobytes()


def velocity(solve: Solve) -> np.ndarray:
    return np.stack([solve.velocities[axis] for axis in ("vx", "vy", "vz", "wx", "wy", "wz")])


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("solver", PACKED)
def test_packed_sweeps_leave_what_row_by_row_sweeps_leave(name: str, solver: str) -> None:
    prepared = found(name)
    plain, packed = Solve(prepared, "projected_gauss_seidel"), Solve(prepared, solver)
    heaviest = (1.0 / prepared.contacts["k_n"]).max()  # [kg] that an impulse may have to move
    for sweeps in (0, 1, 2, 5, 20):
        plain.run(sweeps)
        packed.run(sweeps)
        assert packed.sweeps == plain.sweeps
        allowed = ROUND_OFF * SPEED * max(sweeps, 1)
        np.testing.assert_allclose(packed.impulses, plain.impulses, rtol=0, atol=allowed * heaviest)
        # a turn of 1 rad/s moves surfaces 0.1 m away
        np.testing.assert_allclose(velocity(packed), velocity(plain), rtol=0, atol=10 * allowed)
        assert packed.residual == pytest.approx(plain.residual, abs=10 * allowed)


@pytest.mark.parametrize("name", SCENES)
def test_eight_at_a_time_give_the_bits_of_one_at_a_time(name: str) -> None:
    prepared = found(name)
    one, eight = (Solve(prepared, solver) for solver in PACKED)
    for sweeps in (1, 2, 3, 50):
        one.run(sweeps)
        eight.run(sweeps)
        assert left(one) == left(eight)
        assert (one.sweeps, one.residual) == (eight.sweeps, eight.residual)


def test_the_scenes_have_what_could_go_wrong() -> None:
    """Groups in which some stick and some slide, groups filled up, bodies shared by lanes."""
    solve = Solve(found("mixed"), "coloured_gauss_seidel")
    solve.run(20)
    contacts, impulses = solve.contacts, solve.impulses
    tangential, limit = np.hypot(*impulses.T[1:]), contacts["mu"] * impulses[:, 0]
    slides = (tangential > 0.999 * limit) & (limit > 0.0)
    sticks = (tangential < 0.9 * limit) & (limit > 0.0)
    group = np.empty(len(contacts), np.int64)
    group[found("mixed").order] = solve.workspace.slot // WIDTH
    assert set(group[slides]) & set(group[sticks])
    assert len(set(group)) * WIDTH > len(contacts)  # some lanes are filled up
    assert (np.unique(group, return_counts=True)[1] == WIDTH).any()  # and some groups are full
    assert {"frictional", "gamma", "surface_1"} <= set(contacts.dtype.names)
    assert 0 < np.count_nonzero(contacts["frictional"] == 0) < len(contacts)
    assert (contacts["gamma"] > 0.0).any()
    assert (contacts["surface_1"] != 0.0).any()
    assert (np.abs(found("mixed").contacts["lambda_n"]) > 0.0).any()  # a warm start


@pytest.mark.parametrize("name", ["towers", "mixed"])
def test_no_group_holds_a_movable_body_twice(name: str) -> None:
    prepared = found(name)
    solve = Solve(prepared, "coloured_gauss_seidel")
    solve.run(1)
    members: dict[int, list[int]] = {}
    for contact, slot in zip(prepared.contacts[prepared.order], solve.workspace.slot, strict=True):
        ends = [i for i in (contact["a"], contact["b"]) if prepared.bodies[i]["inv_m"] > 0.0]
        members.setdefault(slot // WIDTH, []).extend(int(i) for i in ends)
    assert all(len(set(ends)) == len(ends) for ends in members.values())
    assert np.all(np.diff(solve.workspace.slot) > 0)  # in the order of the sweep


@pytest.mark.parametrize("solver", PACKED)
def test_velocities_carry_the_impulses_and_the_residual_is_an_independent_natural_map(
    solver: str,
) -> None:
    prepared = found("mixed")
    inverse, rows, before = mechanics(prepared)
    warm = np.stack([prepared.contacts[f"lambda_{axis}"] for axis in "n12"], axis=1)
    solve = Solve(prepared, solver)
    for sweeps in (0, 3, 20):
        solve.run(sweeps)
        after = before + inverse @ (rows.T @ (solve.impulses - warm).ravel())
        allowed = ROUND_OFF * SPEED * max(sweeps, 1)
        np.testing.assert_allclose(velocity(solve).T.ravel(), after, rtol=0, atol=10 * allowed)
        w = (rows @ after).reshape(-1, 3)
        w[:, 0] += solve.contacts["target"]
        w[:, 1] += solve.contacts["surface_1"]
        w[:, 2] += solve.contacts["surface_2"]
        expected = natural_maps(solve.contacts, w, solve.impulses)
        # compliance multiplies the round-off of impulses by gamma / k
        soft = 1.0 + (solve.contacts["gamma"] * solve.contacts["inv_k"]).max()
        assert solve.residual == pytest.approx(expected.max(), abs=10 * soft * allowed)


@pytest.mark.parametrize("solver", PACKED)
def test_a_tolerance_ends_the_sweeps_where_the_residual_has_reached_it(solver: str) -> None:
    tolerance = 1e-6
    every, solve = Solve(found("towers"), solver), Solve(found("towers"), solver, tolerance)
    solve.run(3000)
    assert 1 < solve.sweeps < 3000
    assert solve.residual <= tolerance
    every.run(solve.sweeps)  # records are those of this sweep, not of an earlier one
    assert (left(every), every.residual) == (left(solve), solve.residual)


@pytest.mark.parametrize("solver", PACKED)
def test_a_sweep_that_changes_nothing_is_the_last(solver: str) -> None:
    """One ball's normal and disc are one block: the first sweeps solve it to the last bit."""
    solve = Solve(found("one ball"), solver)
    solve.run(1000)
    assert solve.sweeps < 10


@pytest.mark.parametrize("solver", PACKED)
def test_what_is_not_a_number_is_reported(solver: str) -> None:
    prepared = found("towers")
    broken = prepared._replace(velocities=prepared.velocities.copy())
    broken.velocities["vx"][3] = np.nan
    solve = Solve(broken, solver)
    solve.run(5)
    assert np.isnan(solve.residual)


def test_what_an_earlier_solve_left_in_the_arrays_does_not_matter() -> None:
    """Where eight lanes are not filled, an earlier solve may have left a contact that never comes
    to rest; the greatest change of any lane says when sweeps are over.
    """
    clean, dirty = (Solve(found("towers"), "coloured_gauss_seidel", 1e-6) for _ in range(2))
    fields = dirty.workspace.rows.reshape(-1, BLOCK, WIDTH)
    fields[:, [INV_K, K_N]], fields[:, W_N] = 1.0, -1.0  # pushed by 1 m/s, and never moved
    for array in (dirty.workspace.state, dirty.workspace.start, dirty.workspace.factor):
        array[...] = 7.0
    dirty.workspace.group_of[...] = 0
    clean.run(3000)
    dirty.run(3000)
    assert clean.sweeps < 3000
    assert (clean.sweeps, left(clean)) == (dirty.sweeps, left(dirty))


@pytest.mark.parametrize("solver", PACKED)
def test_kept_machine_code_gives_the_bits_of_fresh_machine_code(solver: str) -> None:
    fresh = Solve(found("mixed"), solver, anew=True)
    kept = Solve(found("mixed"), solver)
    assert (fresh.loaded, kept.loaded) == (False, True)
    for sweeps in (1, 20):
        fresh.run(sweeps)
        kept.run(sweeps)
        assert left(fresh) == left(kept)


@pytest.mark.parametrize("solver", PACKED)
def test_contacts_that_are_no_such_blocks_are_swept_as_records(solver: str) -> None:
    for spec in (
        BLOCKS.including("torsional_friction"),
        BLOCKS.including("rolling_friction"),
        BLOCKS.including("capture_in_sweeps"),
        BLOCKS.without("friction", "surface_velocity"),
        BLOCKS._replace(friction_cone="pyramid"),
        BLOCKS._replace(friction_cone="convex"),
        BLOCKS._replace(over_relaxation=True),
        BLOCKS._replace(order="symmetric"),
        BLOCKS._replace(operator="matrix"),
    ):
        declared = SOLVERS[solver]
        assert declared.allocate(spec, 2, 2) == ()
        assert declared.iteration(spec).sweep.py_func.__name__ == "sweep_in_order"


def test_rows_of_joints_are_never_packed() -> None:
    assert can_pack(EVERYTHING)
    assert not can_pack(EVERYTHING.including("joint"))
