"""Reader and writer of FCLIB's HDF5 files of contact problems (local and global form).

    /fclib_local /{spacedim, W, vectors/{q, mu}, info/{title, description, math_info}}
    /fclib_global/{spacedim, M, H, vectors/{f, w, mu}, info/...}
    /solution/{u, r},  /guesses/{number_of_guesses, 1/{u, r}, ...}
    a matrix: nzmax m n nz p i x; nz >= 0 triplets (row i, column p), -1 by columns, -2 by rows
Layout after fclib.c and fclib.h of github.com/FrictionalContactLibrary/fclib. Files of others hold
solutions that are none (r = 0), so none is read. The only file here that knows h5py.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from scipy import sparse

from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.errors import ProblemError
from lavendersim.problems.matrices import DIMENSION, matrix_of, problem_of
from lavendersim.problems.reduced_problem import reduce_to_contacts

SIGNATURE = b"\x89HDF\r\n\x1a\n"  # the first bytes of every HDF5 file
LOCAL, GLOBAL = "fclib_local", "fclib_global"
BILATERAL = {LOCAL: ("V", "R"), GLOBAL: ("G",)}  # matrices of joints beside the contacts
BY_COLUMNS, BY_ROWS = -1, -2
# What h5py raises where bytes within a file are wrong, depending on which.
DAMAGED = (OSError, RuntimeError, KeyError, TypeError, ValueError)


def _h5py(file: Path) -> Any:
    try:
        import h5py
    except ImportError:
        raise ProblemError(
            f"{file}: HDF5 files need h5py, install it with: pip install 'lavendersim[hdf5]'"
        ) from None
    return h5py


def read_fclib(file: Path) -> ContactProblem:
    """Read a problem, the global form reduced to its contacts; ProblemError where there is none."""
    h5py = _h5py(file)
    try:
        with h5py.File(file, "r") as opened:
            form, parts = _read(file, opened)
    except DAMAGED:
        raise ProblemError(f"{file}: not a whole HDF5 file, it is cut off or damaged") from None
    return problem_of(*parts) if form == LOCAL else reduce_to_contacts(file, *parts)


def _read(file: Path, opened: Any) -> tuple[str, tuple[Any, ...]]:
    """Return the form, and what `problem_of` or `reduce_to_contacts` take."""
    form = next((name for name in (LOCAL, GLOBAL) if name in opened), None)
    if form is None:
        there = ", ".join(sorted(opened)) or "nothing"
        raise ProblemError(f"{file}: expected a group {LOCAL} or {GLOBAL}, there is {there}")
    group = opened[form]
    dimension = _whole(file, group, "spacedim")
    if dimension != DIMENSION:
        raise ProblemError(f"{file}: expected a problem of dimension {DIMENSION}, not {dimension}")
    for name in BILATERAL[form]:
        if name in group:
            raise ProblemError(
                f"{file}: expected contacts alone, {form}/{name} holds joints between bodies"
            )
    mu = _vector(file, group, "vectors/mu")
    if len(mu) == 0 or mu.min() < 0.0:
        raise ProblemError(f"{file}: expected {form}/vectors/mu, one of at least 0 per contact")
    rows = DIMENSION * len(mu)
    if form == LOCAL:
        matrix = _matrix(file, group, "W")
        if matrix.shape != (rows, rows):
            raise ProblemError(
                f"{file}: expected W with {rows} rows and columns for {len(mu)} contacts, "
                f"it is {matrix.shape[0]} by {matrix.shape[1]}"
            )
        return form, (matrix, _vector(file, group, "vectors/q", rows), mu)
    mass, directions = _matrix(file, group, "M"), _matrix(file, group, "H")
    f = _vector(file, group, "vectors/f", mass.shape[0])
    w = _vector(file, group, "vectors/w", rows)
    return form, (mass, directions, f, w, mu)


def _dataset(file: Path, group: Any, name: str) -> np.ndarray:
    """Return a dataset's numbers as one row."""
    where = f"{group.name.lstrip('/')}/{name}"
    try:
        values = np.asarray(group[name][()]).ravel()
    except KeyError:
        raise ProblemError(f"{file}: expected {where}, it is missing") from None
    except (OSError, AttributeError, TypeError, ValueError):
        raise ProblemError(f"{file}: expected numbers in {where}") from None
    if values.dtype.kind not in "iuf":
        raise ProblemError(f"{file}: expected numbers in {where}")
    return values


def _whole(file: Path, group: Any, name: str) -> int:
    values = _dataset(file, group, name)
    if len(values) != 1 or values.dtype.kind not in "iu":
        where = f"{group.name.lstrip('/')}/{name}"
        raise ProblemError(f"{file}: expected one whole number in {where}")
    return int(values[0])


def _vector(file: Path, group: Any, name: str, size: int | None = None) -> np.ndarray:
    values = _dataset(file, group, name).astype(np.float64)
    where = f"{group.name.lstrip('/')}/{name}"
    if size is not None and len(values) != size:
        raise ProblemError(f"{file}: expected {size} numbers in {where}, there are {len(values)}")
    if not np.isfinite(values).all():
        raise ProblemError(f"{file}: expected finite numbers in {where}")
    return values


def _matrix(file: Path, parent: Any, name: str) -> Any:
    """Return a matrix of any of the three storages as a sparse one."""
    if name not in parent:
        raise ProblemError(f"{file}: expected {parent.name.lstrip('/')}/{name}, it is missing")
    group = parent[name]
    where = group.name.lstrip("/")
    shape = (_whole(file, group, "m"), _whole(file, group, "n"))
    storage = _whole(file, group, "nz")
    if storage < BY_ROWS or min(shape) < 1:
        raise ProblemError(f"{file}: expected m, n above 0 and nz at least {BY_ROWS} in {where}")
    p, i = _dataset(file, group, "p"), _dataset(file, group, "i")
    x = _vector(file, group, "x")
    if p.dtype.kind == "f" or i.dtype.kind == "f":
        raise ProblemError(f"{file}: expected whole numbers in {where}/p and {where}/i")
    p, i = p.astype(np.int64), i.astype(np.int64)
    if storage >= 0:
        major, count = p, storage
    else:
        lines = shape[1] if storage == BY_COLUMNS else shape[0]
        if len(p) != lines + 1 or p[0] != 0 or (np.diff(p) < 0).any():
            raise ProblemError(
                f"{file}: expected {lines + 1} numbers in {where}/p that ascend from 0"
            )
        major, count = np.repeat(np.arange(lines), np.diff(p)), int(p[-1])
    # nzmax is a capacity: arrays may be longer than what is used of them.
    if min(len(major), len(i), len(x)) < count:
        raise ProblemError(f"{file}: expected {count} entries in {where}, its arrays are shorter")
    row, column = i[:count], major[:count]
    if storage == BY_ROWS:
        row, column = column, row
    for index, size in ((row, shape[0]), (column, shape[1])):
        if count and (index.min() < 0 or index.max() >= size):
            raise ProblemError(
                f"{file}: expected entries of {where} within {shape[0]} rows and {shape[1]} columns"
            )
    return sparse.coo_matrix((x[:count], (row, column)), shape=shape)


def write_fclib(
    file: Path,
    problem: ContactProblem,
    *,
    title: str = "",
    description: str = "",
    guess: np.ndarray | None = None,
    solution: np.ndarray | None = None,
    attributes: Mapping[str, int] | None = None,
) -> None:
    """Write the local form; equal problems give equal bytes.

    FCLIB knows neither regularisation nor targets: gamma goes onto W's normal diagonal, target into
    q, so what is read back has the same solutions and velocities w. `guess` and `solution` (n, 3)
    [N s] are stored with their velocities; `attributes` are whole numbers that stand at the group
    `info`.
    Raises ProblemError without contacts.
    """
    if problem.contacts == 0:
        raise ProblemError(f"{file}: a problem without contacts cannot be stored as FCLIB's")
    h5py = _h5py(file)
    matrix, q = matrix_of(problem), problem.q
    with h5py.File(file, "w", libver=("earliest", "v108")) as opened:
        group = opened.create_group(LOCAL)
        _write(group, "spacedim", [DIMENSION], np.int32)
        stored = group.create_group("W")
        for name, value in (("nzmax", matrix.nnz), ("m", matrix.shape[0]), ("n", matrix.shape[1])):
            _write(stored, name, [value], np.int32)
        _write(stored, "nz", [BY_COLUMNS], np.int32)
        _write(stored, "p", matrix.indptr, np.int32)
        _write(stored, "i", matrix.indices, np.int32)
        _write(stored, "x", matrix.data, np.float64)
        vectors = group.create_group("vectors")
        _write(vectors, "q", q.ravel(), np.float64)
        _write(vectors, "mu", problem.mu, np.float64)
        info = group.create_group("info")
        for name, text in (("title", title), ("description", description), ("math_info", "")):
            _write_text(h5py, info, name, text)
        for name, whole in (attributes or {}).items():
            info.attrs.create(name, whole, dtype=np.int32)
        if solution is not None:
            _write_impulses(opened.create_group("solution"), matrix, q, solution)
        if guess is not None:
            guesses = opened.create_group("guesses")
            _write(guesses, "number_of_guesses", [1], np.int32)
            _write_impulses(guesses.create_group("1"), matrix, q, guess)


def _write_impulses(group: Any, matrix: Any, q: np.ndarray, impulses: np.ndarray) -> None:
    r = np.asarray(impulses, dtype=np.float64).ravel()
    _write(group, "u", matrix @ r + q.ravel(), np.float64)
    _write(group, "r", r, np.float64)


def _write(group: Any, name: str, values: Any, kind: Any) -> None:
    group.create_dataset(name, data=np.asarray(values, dtype=kind), track_times=False)


def _write_text(h5py: Any, group: Any, name: str, text: str) -> None:
    """Write a text as C reads it: of fixed length, ended by a zero."""
    data = text.encode()
    kind = h5py.h5t.C_S1.copy()
    kind.set_size(len(data) + 1)
    kind.set_strpad(h5py.h5t.STR_NULLTERM)
    space = h5py.h5s.create(h5py.h5s.SCALAR)
    made = h5py.h5d.create(group.id, name.encode(), kind, space)
    made.write(space, space, np.array(data, dtype=f"S{len(data) + 1}"), kind)
