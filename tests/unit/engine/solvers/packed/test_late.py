"""The default's sweeps are packed where a solve of many contacts is a long one, and stay the same.

Engines of Newton's method beside them: `test_packed_engines`.
"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from interpreted import interpreted
from packed_scenes import BLOCKS, found

from lavendersim.engine.slabs import FEWEST_CONTACTS as FEWEST_TOGETHER
from lavendersim.engine.solvers.packed import late
from lavendersim.engine.solvers.packed.late import FEWEST_CONTACTS, FIRST, Packing, packs_late
from lavendersim.engine.solvers.packed.layout import TOGETHER
from tests.benchmarks.prepared_contacts import Solve

# As in `test_sweep`: velocities of some m/s, a hundred roundings a visit, some visits in a row.
ROUND_OFF = 2.0**-53 * 100 * 100
SPEED = 5.0  # [m/s] nothing in the scenes is faster
ADAPTIVE = BLOCKS._replace(solver="adaptive")


def left(solve: Solve) -> bytes:
    return solve.impulses.tobytes() + solve.velocities.tobytes()


def velocity(solve: Solve) -> np.ndarray:
    return np.stack([solve.velocities[axis] for axis in ("vx", "vy", "vz", "wx", "wy", "wz")])


def pair(name: str) -> tuple[Solve, Solve]:
    """Return the sweeps over the records, and those that are packed when a solve is long."""
    prepared = found(name)
    return Solve(prepared, "projected_gauss_seidel"), Solve(prepared, "adaptive")


def test_first_sweeps_and_solves_of_few_contacts_have_the_bits_of_sweeps_over_the_records() -> None:
    for name, sweeps in (("many towers", (0, 1, FIRST)), ("towers", (1, 5, 20))):
        plain, late = pair(name)
        assert (late.count >= FEWEST_CONTACTS) == (name == "many towers")
        for most in sweeps:
            plain.run(most)
            late.run(most)
            assert left(plain) == left(late)
            assert (plain.sweeps, plain.residual) == (late.sweeps, late.residual)


def test_later_sweeps_leave_what_sweeps_over_the_records_leave() -> None:
    plain, late = pair("many towers")
    heaviest = (1.0 / late.contacts["k_n"]).max()  # [kg] that an impulse may have to move
    for sweeps in (FIRST + 1, 5, 20, 50):
        plain.run(sweeps)
        late.run(sweeps)
        assert late.sweeps == plain.sweeps == sweeps
        allowed = ROUND_OFF * SPEED * sweeps
        np.testing.assert_allclose(late.impulses, plain.impulses, rtol=0, atol=allowed * heaviest)
        # a turn of 1 rad/s moves surfaces 0.1 m away
        np.testing.assert_allclose(velocity(late), velocity(plain), rtol=0, atol=10 * allowed)
        assert late.residual == pytest.approx(plain.residual, abs=10 * allowed)
        assert left(plain) != left(late)  # or nothing was packed


def test_packed_sweeps_are_those_of_lanes_after_the_first_sweeps_over_the_records() -> None:
    """Eight at a time from where the records were left: the bits of `coloured_gauss_seidel`."""
    prepared = found("many towers")
    first, late = (Solve(prepared, "adaptive") for _ in range(2))
    first.run(FIRST)
    begun = prepared._replace(contacts=first.contacts.copy(), velocities=first.velocities.copy())
    for lanes in ("coloured_gauss_seidel", "block_gauss_seidel"):
        rest = Solve(begun, lanes)
        rest.run(20)
        late.run(FIRST + 20)
        assert left(rest) == left(late)


@pytest.mark.parametrize(
    "spec",
    [
        ADAPTIVE.without("packed_sweeps"),
        ADAPTIVE._replace(solver="projected_gauss_seidel"),
        ADAPTIVE.including("capture_in_sweeps"),
        ADAPTIVE._replace(friction_cone="pyramid"),
        ADAPTIVE._replace(over_relaxation=True),
        ADAPTIVE._replace(order="symmetric"),
    ],
    ids=lambda spec: f"{spec.solver} {spec.friction_cone} {spec.order} {len(spec.effects)}",
)
def test_contacts_that_cannot_be_packed_stay_in_the_records(spec) -> None:
    assert packs_late(ADAPTIVE)
    assert not packs_late(spec)


def sweeps_made(monkeypatch: pytest.MonkeyPatch, recorded: bool) -> tuple[list[int], list[Any]]:
    """Return the sizes of what is swept at once, and what each sweep returns."""
    made: list[int] = []

    def one(packed: Any, slots: int) -> float:
        made.append(1)
        return float(len(made))

    def nothing(*arguments: Any) -> None:
        raise AssertionError(arguments)

    def together(packed: Any, slots: int, sweeps: int) -> None:
        made.append(sweeps)

    for name, kernel in {
        "make_sweep": nothing,
        "make_sweep_packed": one,
        "make_sweep_together": together,
        "make_pack": lambda system, packed: 8,
        "make_unpack": nothing,
    }.items():
        made_of = SimpleNamespace(py_func=kernel)
        monkeypatch.setattr(late, name, lambda *args, _kernel=made_of, **how: _kernel)
    spec = ADAPTIVE.including("residual_log") if recorded else ADAPTIVE
    sweep = interpreted(late.make_sweep_late(spec)[0])
    system = SimpleNamespace(count=FEWEST_TOGETHER)
    packed = SimpleNamespace(changes=np.zeros(TOGETHER))
    packing, seen = Packing(FIRST, 0, 0), []
    for sweeps in range(12):
        greatest, _, packing = sweep(system, packed, None, packing, 11 - sweeps, sweeps < 10)
        seen.append((math.isinf(greatest), packing))
    return made, seen


def test_sweeps_that_are_recorded_count_as_those_that_are_made_together(monkeypatch) -> None:
    """What is begun from several (`extrapolation`) is, in both, where a few together ended."""
    together, seen = sweeps_made(monkeypatch, recorded=False)
    singly, seen_singly = sweeps_made(monkeypatch, recorded=True)
    assert together == [TOGETHER, TOGETHER, 3, 1]
    assert singly == [1] * 12
    assert seen_singly == seen
