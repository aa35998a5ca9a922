"""FCLIB's HDF5 files: what we write is read back to the bit, by us and by its own layout."""

from __future__ import annotations

import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
from gauss_seidel import dense
from made_problems import outside, random_bodies, random_problem, without_softness
from scipy import sparse

from lavendersim.errors import ProblemError
from lavendersim.problems.fclib import write_fclib
from lavendersim.problems.read import read_problem
from lavendersim.problems.residual import contact_velocities, residual

PROBLEM = without_softness(random_problem(7))


@outside
def test_problems_of_others_come_back_to_the_bit(file: Path, tmp_path: Path) -> None:
    problem = read_problem(file)
    write_fclib(tmp_path / "again.hdf5", problem)
    again = read_problem(tmp_path / "again.hdf5")
    for name, before, after in zip(problem._fields, problem, again, strict=True):
        assert before.dtype == after.dtype
        assert np.array_equal(before, after), name


def test_a_problem_comes_back_to_the_bit(tmp_path: Path) -> None:
    write_fclib(tmp_path / "p.hdf5", PROBLEM)
    again = read_problem(tmp_path / "p.hdf5")
    for before, after in zip(PROBLEM, again, strict=True):
        assert np.array_equal(before, after)


def test_softness_and_targets_go_into_w_and_q(tmp_path: Path) -> None:
    soft = random_problem(8)
    assert soft.gamma.any()
    assert soft.target.any()
    write_fclib(tmp_path / "p.hdf5", soft)
    plain = read_problem(tmp_path / "p.hdf5")
    assert not plain.gamma.any()
    assert not plain.target.any()
    r = np.random.default_rng(2).normal(size=(soft.contacts, 3))
    # The same sums of 3 n + 2 terms in another order.
    size = np.abs(dense(soft)[0]) @ np.abs(r).ravel() + np.abs(soft.free).max()
    bound = (3 * soft.contacts + 2) * np.finfo(float).eps * size.max()
    assert np.abs(contact_velocities(soft, r) - contact_velocities(plain, r)).max() <= bound
    assert residual(plain, r).scaled == pytest.approx(residual(soft, r).scaled, rel=1e-12)


def test_the_layout_is_fclibs(tmp_path: Path) -> None:
    """Names, types and shapes that fclib.c reads into int and double."""
    r = np.arange(3.0 * PROBLEM.contacts).reshape(-1, 3)
    write_fclib(
        tmp_path / "p.hdf5",
        PROBLEM,
        title="pile",
        guess=r,
        solution=2.0 * r,
        attributes={"step": 4},
    )
    with h5py.File(tmp_path / "p.hdf5") as file:
        local = file["fclib_local"]
        wholes = [local["spacedim"], *(local["W"][name] for name in ("m", "n", "nz", "nzmax"))]
        assert [(one.shape, one.dtype) for one in wholes] == [((1,), np.int32)] * 5
        nonzeros = len(local["W/x"])
        assert [int(one[0]) for one in wholes] == [3, 15, 15, -1, nonzeros]
        for name, size, kind in (("p", 16, "i4"), ("i", nonzeros, "i4"), ("x", nonzeros, "f8")):
            assert local[f"W/{name}"].shape == (size,)
            assert local[f"W/{name}"].dtype == np.dtype(kind)
        matrix, q = dense(PROBLEM)
        stored = sparse.csc_matrix((local["W/x"][()], local["W/i"][()], local["W/p"][()]))
        assert np.array_equal(stored.toarray(), matrix)
        assert np.array_equal(local["vectors/q"][()], q)
        assert np.array_equal(local["vectors/mu"][()], PROBLEM.mu)
        title = local["info/title"]
        assert (title.shape, title[()]) == ((), b"pile")
        assert title.id.get_type().get_strpad() == h5py.h5t.STR_NULLTERM
        assert local["info"].attrs["step"] == 4
        assert list(file["guesses/number_of_guesses"]) == [1]
        assert np.array_equal(file["guesses/1/r"][()], r.ravel())
        assert np.array_equal(file["solution/r"][()], 2.0 * r.ravel())
        assert file["solution/u"][()] == pytest.approx(matrix @ (2.0 * r.ravel()) + q)


def test_equal_problems_give_equal_bytes(tmp_path: Path) -> None:
    for name in ("one.hdf5", "two.hdf5"):
        write_fclib(tmp_path / name, PROBLEM, title="same")
    assert (tmp_path / "one.hdf5").read_bytes() == (tmp_path / "two.hdf5").read_bytes()


def put_matrix(group: h5py.Group, name: str, matrix: np.ndarray, storage: int) -> None:
    """Store a matrix as triplets, by columns (-1) or by rows (-2), with room that is not used."""
    made = group.create_group(name)
    table = {0: sparse.coo_matrix, -1: sparse.csc_matrix, -2: sparse.csr_matrix}[storage](matrix)
    p, i = (table.col, table.row) if storage == 0 else (table.indptr, table.indices)
    made["m"], made["n"] = [matrix.shape[0]], [matrix.shape[1]]
    made["nz"], made["nzmax"] = [table.nnz if storage == 0 else storage], [table.nnz + 3]
    made["p"] = p.astype(np.int32)
    made["i"] = np.append(i, [-7, -7, -7]).astype(np.int32)
    made["x"] = np.append(table.data, [np.pi] * 3)


@pytest.mark.parametrize("storage", [0, -1, -2])
def test_every_storage_of_a_matrix_is_read(storage: int, tmp_path: Path) -> None:
    bodies = random_bodies(9)
    with h5py.File(tmp_path / "p.h5", "w") as file:
        group = file.create_group("fclib_global")
        group["spacedim"] = [3]
        put_matrix(group, "M", bodies.mass, storage)
        put_matrix(group, "H", bodies.directions, storage)
        vectors = group.create_group("vectors")
        vectors["f"], vectors["w"], vectors["mu"] = bodies.f, bodies.w, bodies.mu
    matrix, q = dense(read_problem(tmp_path / "p.h5"))
    solved = np.linalg.solve(bodies.mass, np.column_stack([bodies.directions, bodies.f]))
    # As for text files: n eps cond(M) of two factorisations, n = 24, cond(M) < 100.
    assert np.linalg.cond(bodies.mass) < 100.0
    bound = 24 * 100.0 * 2.0 * np.finfo(float).eps
    expected = bodies.directions.T @ solved
    assert np.abs(matrix - expected[:, :-1]).max() <= bound * np.abs(expected).max()
    assert np.abs(q - bodies.w - expected[:, -1]).max() <= bound * np.abs(expected).max()


def replace(name: str, value):
    def change(file: h5py.File) -> None:
        del file[name]
        if value is not None:
            file[name] = value

    return change


DAMAGE = {
    "no group": (lambda file: file.move("fclib_local", "other"), "there is other"),
    "plane": (replace("fclib_local/spacedim", [2]), "dimension 3, not 2"),
    "no W": (replace("fclib_local/W", None), "expected fclib_local/W, it is missing"),
    "no q": (replace("fclib_local/vectors/q", None), "vectors/q, it is missing"),
    "short q": (replace("fclib_local/vectors/q", np.zeros(4)), "15 numbers in"),
    "q not finite": (replace("fclib_local/vectors/q", np.full(15, np.inf)), "finite numbers"),
    "q is a group": (
        lambda file: (
            replace("fclib_local/vectors/q", None)(file)
            or file.create_group("fclib_local/vectors/q")
        ),
        "expected numbers in",
    ),
    "negative mu": (replace("fclib_local/vectors/mu", np.full(5, -0.1)), "of at least 0"),
    "mu a text": (replace("fclib_local/vectors/mu", "high"), "expected numbers in"),
    "another size": (replace("fclib_local/vectors/mu", np.ones(4)), "12 rows and columns"),
    "storage": (replace("fclib_local/W/nz", [-3]), "nz at least -2"),
    "short x": (replace("fclib_local/W/x", np.zeros(3)), "its arrays are shorter"),
    "falling p": (replace("fclib_local/W/p", np.arange(16)[::-1]), "that ascend from 0"),
    "row beyond": (replace("fclib_local/W/i", np.full(500, 15)), "within 15 rows"),
    "joints": (lambda file: file.create_group("fclib_local/V"), "holds joints"),
}


@pytest.mark.parametrize(("damage", "sentence"), DAMAGE.values(), ids=DAMAGE)
def test_what_is_wrong_is_reported_in_one_sentence(damage, sentence: str, tmp_path: Path) -> None:
    path = tmp_path / "p.hdf5"
    write_fclib(path, PROBLEM)
    with h5py.File(path, "r+") as file:
        damage(file)
    with pytest.raises(ProblemError) as error:
        read_problem(path)
    assert sentence in str(error.value)
    assert str(error.value).startswith(f"{path}: ")
    assert "\n" not in str(error.value)


def test_a_truncated_file_is_reported(tmp_path: Path) -> None:
    path = tmp_path / "p.hdf5"
    write_fclib(path, PROBLEM)
    whole = path.read_bytes()
    for part in (8, 100, len(whole) // 2, len(whole) - 1):
        path.write_bytes(whole[:part])
        with pytest.raises(ProblemError, match="not a whole HDF5 file"):
            read_problem(path)


def test_a_damaged_file_is_refused_or_read(tmp_path: Path) -> None:
    """Bytes changed anywhere: some change a number only, no other may end in anything else."""
    path = tmp_path / "p.hdf5"
    write_fclib(path, PROBLEM)
    whole = path.read_bytes()
    rng = np.random.default_rng(3)
    messages = []
    for _ in range(200):
        damaged = bytearray(whole)
        for place in rng.integers(8, len(whole), 5):
            damaged[place] = rng.integers(256)
        path.write_bytes(damaged)
        try:
            read_problem(path)
        except ProblemError as error:
            messages.append(str(error))
    assert len(messages) > 20
    assert not any("\n" in sentence for sentence in messages)


def test_without_h5py_a_sentence_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_fclib(tmp_path / "p.hdf5", PROBLEM)
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(ProblemError, match=r"pip install 'lavendersim\[hdf5\]'"):
        read_problem(tmp_path / "p.hdf5")


def test_a_problem_without_contacts_is_not_written(tmp_path: Path) -> None:
    nothing = random_problem(1)._replace(mu=np.zeros(0))
    with pytest.raises(ProblemError, match="without contacts"):
        write_fclib(tmp_path / "p.hdf5", nothing)
    assert not (tmp_path / "p.hdf5").exists()
