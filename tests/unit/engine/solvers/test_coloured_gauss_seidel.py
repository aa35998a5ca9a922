"""Which engines pack their contacts by eights; all others sweep plainly."""

from __future__ import annotations

import numpy as np
import pytest
from matrix_solves import matrix_spec, solve
from problems_in_blocks import random_problem

from lavendersim.engine.compile import composing
from lavendersim.engine.solvers import coloured_gauss_seidel, projected_gauss_seidel
from lavendersim.engine.solvers.packed.layout import stride
from lavendersim.engine.spec import Spec

ROUGH = ("contact_torque", "friction", "rotation")
BLOCKS = Spec(ROUGH, ("box_box",), "coloured_gauss_seidel")


def sweeps_of(module, spec: Spec) -> set[str]:
    with composing() as composed:
        module.make(spec)
    return {name for _, name in composed}


def test_blocks_of_a_normal_and_a_disc_are_packed() -> None:
    assert "sweep_in_order" not in sweeps_of(coloured_gauss_seidel, BLOCKS)
    rows = coloured_gauss_seidel.allocate(BLOCKS, 5, 7).rows
    assert len(rows) == 7 * stride(BLOCKS, eight=True)


@pytest.mark.parametrize(
    "spec",
    [
        BLOCKS._replace(friction_cone="pyramid"),
        BLOCKS._replace(over_relaxation=True),
        BLOCKS._replace(order="symmetric"),
        BLOCKS.including("rolling_friction"),
        BLOCKS.without("friction"),
    ],
    ids=["pyramid", "over-relaxed", "there and back", "rolling", "frictionless"],
)
def test_all_others_have_the_kernels_of_the_plain_sweeps_and_no_arrays(spec: Spec) -> None:
    assert sweeps_of(coloured_gauss_seidel, spec) == sweeps_of(projected_gauss_seidel, spec)
    assert coloured_gauss_seidel.allocate(spec, 5, 7) == ()


def test_through_a_matrix_the_sweeps_are_the_same_to_the_bit(rng) -> None:
    problem = random_problem(rng, 5)
    one, other = (
        solve(problem, matrix_spec(name))
        for name in ("coloured_gauss_seidel", "projected_gauss_seidel")
    )
    np.testing.assert_array_equal(one.impulses, other.impulses)
    assert one.sweeps == other.sweeps
