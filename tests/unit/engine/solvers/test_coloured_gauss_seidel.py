"""Which engines pack their contacts by eights; all others sweep plainly."""

from __future__ import annotations

import pytest
from solvers_that_pack import check_matrix, check_packs, check_sweeps_plainly, unpacked

from lavendersim.engine.solvers import coloured_gauss_seidel


def test_blocks_of_a_normal_and_a_disc_are_packed_by_eights() -> None:
    check_packs(coloured_gauss_seidel, eight=True)


@pytest.mark.parametrize("engine", unpacked("coloured_gauss_seidel"))
def test_all_others_have_the_kernels_of_the_plain_sweeps_and_no_arrays(engine: str) -> None:
    check_sweeps_plainly(coloured_gauss_seidel, engine)


def test_through_a_matrix_the_sweeps_are_the_same_to_the_bit(rng) -> None:
    check_matrix(coloured_gauss_seidel, rng)
