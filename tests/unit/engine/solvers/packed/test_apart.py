"""Positional projection over packed contacts moves bodies as the pass over the records does."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import Bench, box, plane, planned, resolved, sphere

from lavendersim.engine.solvers.packed.late import FEWEST_CONTACTS

SHARE = 0.2
MANY = 14  # towers, whose contacts are packed
DEPTH = 2e-3  # [m] that bodies start inside one another


def _towers(count: int, friction: float) -> dict:
    bodies = {"floor": plane(friction=friction)}
    for t in range(count):
        for k in range(3):
            bodies[f"box_{t}_{k}"] = box(
                (0.2, 0.3, 0.2),
                (0.5 * t, 0.01 * k, 0.1 + 0.2 * k - DEPTH * (k + 1)),
                mass=1.0 + k,
                friction=friction,
            )
        # No friction with the floor: a row of a normal alone, beside blocks of three.
        bodies[f"ball_{t}"] = sphere(0.1, (0.5 * t, 2.0, 0.1 - DEPTH))
    return bodies


def _cell(towers: int, sweeps: int) -> dict:
    return resolved(
        _towers(towers, 0.4), solver="adaptive", projection=SHARE, projection_sweeps=sweeps,
        slop=1e-4, sweeps=1,
    )  # fmt: skip


def _moved(packs: bool, sweeps: int, towers: int) -> tuple[Bench, np.ndarray]:
    """Return an engine after a step without gravity, and where its bodies are.

    Packed rows are swept by vectors, in compiled code; the pass over the records is interpreted.
    """
    cell, spec = _cell(towers, sweeps), planned(_cell(MANY, sweeps)).spec
    if packs:
        bench = Bench(cell, spec.including("packed_sweeps"))
    else:
        bench = interpreted_bench(cell, spec.without("packed_sweeps"))
    return bench, bench.run(1).pose[-1]


@pytest.mark.parametrize("sweeps", [1, 2, 20])
def test_bodies_are_moved_as_by_the_pass_over_the_records(sweeps: int) -> None:
    """To round-off: poses of some 7 m, a hundred roundings a visit, so many visits."""
    bench, packed = _moved(True, sweeps, MANY)
    other, records = _moved(False, sweeps, MANY)
    assert bench.engine.counters["contacts"][0] >= FEWEST_CONTACTS
    made = [int(one.engine.counters["projection_sweeps"][0]) for one in (bench, other)]
    assert made == [sweeps, sweeps]
    allowed = 2.0**-53 * 7.0 * 100 * sweeps
    np.testing.assert_allclose(packed, records, rtol=0, atol=allowed)
    assert (other.engine.contacts["push"] > 1e-4).any()


def test_a_ball_alone_is_moved_by_its_share_of_what_exceeds_the_slop() -> None:
    """Each ball has one contact, which the first sweep solves: p (d - s) in closed form."""
    bench, pose = _moved(True, 5, MANY)
    names = list(bench.scene.names)
    heights = [pose[names.index(f"ball_{t}"), 2] for t in range(MANY)]
    expected = 0.1 - DEPTH + SHARE * (DEPTH - 1e-4)
    np.testing.assert_allclose(heights, expected, rtol=0, atol=1e-15)


def test_few_contacts_have_the_bits_of_the_pass_over_the_records() -> None:
    bench, packed = _moved(True, 20, 3)
    assert bench.engine.counters["contacts"][0] < FEWEST_CONTACTS
    np.testing.assert_array_equal(packed, _moved(False, 20, 3)[1])
