"""Packed sweeps are the sweeps over the records whatever rows are made of: drawn problems."""

from __future__ import annotations

import numpy as np
import pytest
from packed_drawn import drawn, packed_solver, with_rows

from lavendersim.engine.row_terms import row_terms
from lavendersim.engine.solvers.packed.late import FEWEST_CONTACTS, FIRST
from tests.benchmarks.prepared_contacts import Prepared, Solve
from tests.thorough import THOROUGH

# As in `test_sweep`: velocities of some m/s, a hundred roundings a visit, some visits in a row.
ROUND_OFF = 2.0**-53 * 100 * 100
SPEED = 5.0  # [m/s]
SPINS = [(), ("torsional",), ("rolling",), ("torsional", "rolling")]
OTHERS = [(), ("frictionless", "compliant", "shifted")]
FRICTIONAL = [("frictional", "levers", *spins, *others) for spins in SPINS for others in OTHERS]
SOFT = [(), ("compliant",)]
FRICTIONLESS = [("frictionless", *turns, *soft) for turns in ((), ("levers",)) for soft in SOFT]
# Every term with and without each kind of the others; each of these is compiled twice.
ROWS = FRICTIONAL + FRICTIONLESS
if not THOROUGH:
    ROWS = [*(FRICTIONAL[k] for k in (0, 3, 4, 7)), FRICTIONLESS[0], FRICTIONLESS[3]]
PSI = {"torsional": ("psi_n",), "rolling": ("psi_1", "psi_2")}


def problem(terms: tuple[str, ...], seed: int) -> Prepared:
    """Return a drawn problem whose rows have these terms."""
    found = drawn(seed, "frictional" in terms, "frictional" not in terms and "levers" not in terms)
    return found._replace(spec=with_rows(*terms).without("newton")._replace(shape_pairs=()))


def impulses(solve: Solve, terms: tuple[str, ...]) -> np.ndarray:
    names = ["lambda_n", *(["lambda_1", "lambda_2"] if "frictional" in terms else [])]
    return np.stack([solve.contacts[name] for name in names], axis=1)


def torques(solve: Solve, terms: tuple[str, ...]) -> np.ndarray:
    names = [name for term, names in PSI.items() if term in terms for name in names]
    return np.array([solve.contacts[name] for name in names])


def velocity(solve: Solve) -> np.ndarray:
    return np.stack([solve.velocities[axis] for axis in ("vx", "vy", "vz", "wx", "wy", "wz")])


def same(a: Solve, b: Solve, terms: tuple[str, ...], sweeps: int) -> None:
    """Hold two solves together, to the round-off of so many sweeps."""
    heaviest = (1.0 / a.contacts["k_n"]).max()  # [kg] that an impulse may have to move
    allowed = ROUND_OFF * SPEED * sweeps
    assert a.sweeps == b.sweeps == sweeps
    np.testing.assert_allclose(
        impulses(b, terms), impulses(a, terms), rtol=0, atol=allowed * heaviest
    )
    # A limit of psi is at most 0.02 m of an impulse; to turn a body by 1 rad/s takes less than it
    # takes to move it by 1 m/s.
    np.testing.assert_allclose(
        torques(b, terms), torques(a, terms), rtol=0, atol=allowed * heaviest
    )
    # a turn of 1 rad/s moves surfaces 0.1 m away
    np.testing.assert_allclose(velocity(b), velocity(a), rtol=0, atol=10 * allowed)
    soft = 1.0
    if "compliant" in terms:  # compliance multiplies the round-off of impulses by gamma / k
        soft += (a.contacts["gamma"] * a.contacts["inv_k"]).max()
    assert b.residual == pytest.approx(a.residual, abs=10 * soft * allowed)


@pytest.mark.parametrize("terms", ROWS, ids=" ".join)
def test_packed_sweeps_leave_what_sweeps_over_the_records_leave(terms: tuple[str, ...]) -> None:
    for seed in (1, 2, 3):
        prepared = problem(terms, seed)
        declared = row_terms(prepared.spec)
        assert {term for term in (*SPINS[3], *OTHERS[1], "levers") if getattr(declared, term)} == (
            set(terms) - {"frictional"}
        )
        records, packed = Solve(prepared, "projected_gauss_seidel"), Solve(prepared, "adaptive")
        assert packed.count >= FEWEST_CONTACTS
        for sweeps in (FIRST + 1, 5, 20):
            records.run(sweeps)
            packed.run(sweeps)
            same(records, packed, terms, sweeps)
            assert records.velocities.tobytes() != packed.velocities.tobytes()  # it was packed


@pytest.mark.parametrize(
    "terms", [FRICTIONAL[-1], FRICTIONAL[4], FRICTIONLESS[-1], FRICTIONLESS[0]], ids=" ".join
)
def test_eight_at_a_time_give_the_bits_of_one_at_a_time(terms: tuple[str, ...]) -> None:
    prepared = problem(terms, 4)
    one, eight = (Solve(prepared, packed_solver(width)) for width in (False, True))
    for sweeps in (1, 2, 20):
        one.run(sweeps)
        eight.run(sweeps)
        assert one.contacts.tobytes() == eight.contacts.tobytes()
        assert one.velocities.tobytes() == eight.velocities.tobytes()
        assert (one.sweeps, one.residual) == (eight.sweeps, eight.residual)


def test_the_drawn_problems_have_what_could_go_wrong() -> None:
    """Rows of every kind side by side, on their limits and inside them."""
    solve = Solve(problem(FRICTIONAL[-1], 1), "adaptive")
    solve.run(20)
    contacts = solve.contacts
    pressed, frictional = contacts["lambda_n"] > 0.0, contacts["frictional"] == 1
    sizes = {
        "torsional": np.abs(contacts["psi_n"]),
        "rolling": np.hypot(contacts["psi_1"], contacts["psi_2"]),
        "mu": np.hypot(contacts["lambda_1"], contacts["lambda_2"]),
    }
    for coefficient, size in sizes.items():
        limit, present = contacts[coefficient] * contacts["lambda_n"], contacts[coefficient] > 0.0
        assert (size > 0.999 * limit)[pressed & present].any()
        assert (size < 0.9 * limit)[pressed & present].any()
        assert (pressed & frictional & ~present).any()
        assert not size[~present].any()
    assert (pressed & ~frictional).any()
    assert (contacts["surface_1"] != 0.0).any()
    assert (contacts["gamma"] > 0.0).any()
    assert not pressed.all()


@pytest.mark.parametrize("terms", [FRICTIONAL[-1], FRICTIONLESS[-1]], ids=" ".join)
def test_what_an_earlier_solve_left_in_the_arrays_does_not_matter(terms: tuple[str, ...]) -> None:
    clean, dirty = (Solve(problem(terms, 1), packed_solver(True)) for _ in range(2))
    dirty.workspace.rows[...] = np.nan
    for array in (dirty.workspace.state, dirty.workspace.start, dirty.workspace.factor):
        array[...] = 7.0
    dirty.workspace.group_of[...] = 0
    clean.run(10)
    dirty.run(10)
    if "compliant" not in terms:
        assert clean.sweeps == 10
    assert clean.contacts.tobytes() == dirty.contacts.tobytes()
    assert clean.velocities.tobytes() == dirty.velocities.tobytes()


@pytest.mark.parametrize("terms", [FRICTIONAL[-1], FRICTIONLESS[-1]], ids=" ".join)
def test_what_is_not_a_number_is_reported(terms: tuple[str, ...]) -> None:
    prepared = problem(terms, 1)
    for axis in ("vx", "wz"):
        broken = prepared._replace(velocities=prepared.velocities.copy())
        broken.velocities[axis][5] = np.nan
        solve = Solve(broken, packed_solver(True))
        solve.run(5)
        assert np.isnan(solve.residual)
