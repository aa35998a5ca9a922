"""Siconos' `.dat` files: every storage, both forms, and nothing but whole files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gauss_seidel import dense
from made_problems import outside, random_bodies, random_problem, without_softness
from siconos_text import BANNER, STORAGES, matrix_text, numbers

from lavendersim.errors import ProblemError
from lavendersim.problems.read import read_problem

PROBLEM = without_softness(random_problem(3))
MATRIX, Q = dense(PROBLEM)
MU = PROBLEM.mu


def local_text(storage: str) -> str:
    return f"3\n{len(MU)}\n" + matrix_text(MATRIX, storage) + numbers(Q) + numbers(MU)


def global_text(storage: str) -> str:
    bodies = random_bodies(5)
    return (
        f"3\n{len(bodies.mu)}\n"
        + matrix_text(bodies.mass, storage, (6, 6))
        + matrix_text(bodies.directions, storage, (6, 3))
        + numbers(bodies.f)
        + numbers(bodies.w)
        + numbers(bodies.mu)
    )


def read(text: str, folder: Path):
    file = folder / "problem.dat"
    file.write_text(text)
    return read_problem(file)


@pytest.mark.parametrize("storage", STORAGES)
def test_every_storage_gives_the_matrix_to_the_last_bit(storage: str, tmp_path: Path) -> None:
    problem = read(local_text(storage), tmp_path)
    matrix, q = dense(problem)
    assert np.array_equal(matrix, MATRIX)
    assert np.array_equal(q, Q)
    assert np.array_equal(problem.mu, MU)
    assert not np.array_equal(matrix, matrix.T)


@pytest.mark.parametrize("storage", STORAGES)
def test_the_global_form_is_brought_to_its_contacts(storage: str, tmp_path: Path) -> None:
    bodies = random_bodies(5)
    matrix, q = dense(read(global_text(storage), tmp_path))
    expected = bodies.directions.T @ np.linalg.solve(bodies.mass, bodies.directions)
    # Two factorisations of M, each with an error of some n eps cond(M), n = 24, cond(M) < 100.
    assert np.linalg.cond(bodies.mass) < 100.0
    bound = 24 * 100.0 * 2.0 * np.finfo(float).eps
    assert np.abs(matrix - expected).max() <= bound * np.abs(expected).max()
    expected_q = bodies.w + bodies.directions.T @ np.linalg.solve(bodies.mass, bodies.f)
    assert np.abs(q - expected_q).max() <= bound * np.abs(expected_q).max()


TRIPLETS, COLUMNS = local_text("triplet"), local_text("by columns")
VARIANTS = {
    "one word more": local_text("dense") + "1\n",
    "one line": " ".join(local_text("block").split()),
    "Windows' lines": local_text("triplet").replace("\n", "\r\n"),
    "no banner": TRIPLETS.replace(BANNER + "\n", ""),
    "another banner": COLUMNS.replace(BANNER, "CXSparse Version 4.0.4, 2022,\nCopyright"),
    "no blanks about colons": TRIPLETS.replace(" : ", ": "),
    "no norm": "\n".join(line.partition(", 1-norm")[0] for line in COLUMNS.splitlines()),
}


@pytest.mark.parametrize("text", VARIANTS.values(), ids=VARIANTS)
def test_how_it_is_laid_out_does_not_matter(text: str, tmp_path: Path) -> None:
    assert np.array_equal(dense(read(text, tmp_path))[0], MATRIX)


def test_a_matrix_without_blocks_says_no_more(tmp_path: Path) -> None:
    problem = read("3 2 1 6 6 0 1 0 0 1 0 0 0.5 0.5", tmp_path)
    assert not dense(problem)[0].any()
    assert list(problem.row) == [0, 1]  # the own blocks are there all the same


def test_rows_of_blocks_after_the_last_may_be_left_out(tmp_path: Path) -> None:
    block = "0\n" + "1 0 0 0 2 0 0 0 3"
    problem = read(f"3 2 1 6 6 1 2 2 3 6 3 6 2 1 0 1 1 {block} 1 0 0 1 0 0 0.5 0.5", tmp_path)
    expected = np.zeros((6, 6))
    expected[:3, 3:] = np.diag([1.0, 2.0, 3.0])
    assert np.array_equal(dense(problem)[0], expected)


@pytest.mark.parametrize("form", [local_text, global_text])
@pytest.mark.parametrize("storage", STORAGES)
def test_no_part_of_a_file_passes_for_a_whole_one(form, storage: str, tmp_path: Path) -> None:
    words = form(storage).split()
    # Cuts everywhere near the ends, where parts meet, and some between.
    cuts = {*range(40), *range(len(words) - 40, len(words)), *range(40, len(words), 97)}
    for cut in cuts:
        with pytest.raises(ProblemError, match=r"problem\.dat:1"):
            read(" ".join(words[:cut]), tmp_path)


DIAGONAL = "1 0 0 0 1 0 0 0 1"
WRONG = {
    "": ("dimension", 1),
    "2 1 0 2 2 2 2 1 0 0 1 1 1 0.5": ("dimension 3", 1),
    "3 0": ("number of contacts, at least 1", 1),
    "3\n1\n7 3 3": ("0 dense, 1 block, 2 sparse", 3),
    "3\n1\n0 3 3\n3 4": ("size of W or M again, 3 3", 4),
    f"3\n1\n0 3 3 3 3\n{DIAGONAL}\n1 nan 0 0.5": ("expected q, finite", 5),
    f"3\n1\n0 3 3 3 3\n{DIAGONAL}\n1 x 0 0.5": ('expected q, 3 numbers, found "x"', 5),
    f"3\n1\n0 3 3 3 3\n{DIAGONAL}\n1 0 0\n-0.5": ("mu, at least 0", 6),
    f"3\n1\n0 3 3 3 3\n{DIAGONAL}\n1 0 0 0.5 1\n2": ("end after mu", 5),
    f"3\n2\n0 3 3 3 3\n{DIAGONAL}\n1 0 0 0 0 0 1 1": ("W with 6 rows and columns", 5),
    f"3\n1\n1 3 3 1 1 1 3\n3\n2 1 0 1 0\n1 {DIAGONAL}\n1 0 0 0.5": ("block 0 of W", 6),
    f"3\n1\n1 3 3 1 1 1 3\n3\n2 1 0 1 9\n0 {DIAGONAL}\n1 0 0 0.5": ("blocks of W or M below 1", 5),
    f"3\n1\n1 3 3 1 1 1 4\n3\n2 1 0 1 0\n0 {DIAGONAL}\n1 0 0 0.5": ("that ascend to 3", 3),
    f"3\n1\n1 3 3 1 1 1 3\n3\n2 1 0 2 0\n0 {DIAGONAL}\n1 0 0 0.5": ("begin at 0 and end at 1", 5),
    "3\n1\n2 3 3 4": ("origin of W or M: 1, 2 or 3", 3),
    "3\n1\n2 3 3 1 3-by-3, nzmax: 1 nnz: 1\n0 0 : 1": ("a triplet listing", 3),
    "3\n1\n2 3 3 1 (null)": ("with 3-by-3", 3),
    "3\n1\n2 3 3 1\ntriplet: 3-by-4, nzmax: 1 nnz: 1\n0 0 : 1": ("3-by-3", 4),
    "3\n1\n2 3 3 1\ntriplet: 3-by-3, nzmax: 1\n0 0 : 1": ("as nnz", 5),
    "3\n1\n2 3 3 1\ntriplet: 3-by-3, nnz: 1\n0 5 : 1\n1 0 0 0.5": ("columns of W or M below 3", 6),
    "3\n1\n2 3 3 1\ntriplet: 3-by-3, nnz: 1\n0 0.5 : 1\n": ("a whole number from 0", 5),
    "3\n1\n2 3 3 1\ntriplet: 3-by-3, nnz: 1\n\n0 -1 : 1\n": ("a whole number from 0", 6),
    "3\n1\n2 3 3 2\n3-by-3, nnz: 2\ncol 1 : locations 0 to 0\n0 : 1\ncol 1 : locations 1 to 1\n"
    "1 : 1": ("after column 1, at least 2", 7),
    "3\n1\n2 3 3 2\n3-by-3, nnz: 2\ncol 0 : locations 0 to 0\n0 : 1\n1 0 0 0.5": ("2 entries", 7),
    "3\n1\n2 3 3 2\n3-by-3, nnz: 1\ncol 0 : locations 4 to 4\n0 : 1\n1 0 0 0.5": ("follow 0", 5),
}


@pytest.mark.parametrize(("text", "sentence", "line"), [(t, *w) for t, w in WRONG.items()])
def test_what_is_wrong_is_reported_in_one_sentence(
    text: str, sentence: str, line: int, tmp_path: Path
) -> None:
    with pytest.raises(ProblemError) as error:
        read(text, tmp_path)
    message = str(error.value)
    assert sentence in message
    assert "\n" not in message
    assert message.startswith(f"{tmp_path / 'problem.dat'}:{line}")


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "noise.dat"
    file.write_bytes(np.random.default_rng(1).bytes(4000))
    with pytest.raises(ProblemError, match="dimension"):
        read_problem(file)


@outside
def test_files_of_others_are_read(file: Path) -> None:
    problem = read_problem(file)
    matrix, q = dense(problem)
    assert problem.contacts > 0
    assert np.any(q)
    # Their matrices are H' M^-1 H to 0.2 %: nearly symmetric, and nothing pulls its own contact.
    assert np.abs(matrix - matrix.T).max() <= 2e-3 * np.abs(matrix).max()
    assert np.diag(matrix).min() >= 0.0
    smallest = np.linalg.eigvalsh((matrix + matrix.T) / 2.0)[0]
    assert smallest >= -2e-3 * np.linalg.norm(matrix, 2)
