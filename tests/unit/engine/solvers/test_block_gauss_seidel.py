"""Which engines pack their contacts one by one; all others sweep plainly."""

from __future__ import annotations

import pytest
from solvers_that_pack import check_matrix, check_packs, check_sweeps_plainly, unpacked

from lavendersim.engine.solvers import block_gauss_seidel


def test_blocks_of_a_normal_and_a_disc_are_packed_one_by_one() -> None:
    check_packs(block_gauss_seidel, eight=False)


@pytest.mark.parametrize("engine", unpacked("block_gauss_seidel"))
def test_all_others_have_the_kernels_of_the_plain_sweeps_and_no_arrays(engine: str) -> None:
    check_sweeps_plainly(block_gauss_seidel, engine)


def test_through_a_matrix_the_sweeps_are_the_same_to_the_bit(rng) -> None:
    check_matrix(block_gauss_seidel, rng)
