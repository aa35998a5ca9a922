"""Reader of Siconos' `.dat` files of contact problems, brought to local form.

    local : dimension contacts <W>          q[3 n]           mu[n]
    global: dimension contacts <M> <H> f[m] w[3 n]           mu[n]
    <matrix> = storage rows columns, then by storage
      0 dense : rows columns again, all numbers column by column
      1 block : blocks, rows and columns of blocks, where each ends (cumulative), f1, f2, the
                first block of each row of blocks (f1), the column of each block (f2); then each
                block's number and its numbers column by column
      2 sparse: origin (1 triplet, 2 by columns, 3 by rows), CSparse's banner, then its listing
                triplet: M-by-N, nzmax: Z nnz: K          M-by-N, nzmax: Z nnz: K, 1-norm: X
                    i j : x                                   col j : locations a to b
                                                                i : x
Written after `NM_write_in_file`, `SBM_write_in_file`, `CSparseMatrix_print_in_file` and
`globalFrictionContact_newFromFile` of github.com/siconos/siconos. Some files end with one word more
(a flag of older versions), which means nothing.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from scipy import sparse

from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.problems.matrices import DIMENSION, problem_of
from lavendersim.problems.reduced_problem import reduce_to_contacts
from lavendersim.problems.tokens import Tokens

STORAGES = ("dense", "block", "sparse")
TRIPLET, BY_COLUMNS, BY_ROWS = 1, 2, 3
SHAPE = re.compile(r"^(\d+)-by-(\d+),?$")
LONGEST_BANNER = 40  # [words]; CSparse's has 11


def read_siconos(file: Path) -> ContactProblem:
    """Read a problem; raises ProblemError with file, line and column where it is none."""
    tokens = Tokens(file)
    dimension = tokens.whole("the dimension")
    if dimension != DIMENSION:
        raise tokens.wrong(f"expected a problem of dimension {DIMENSION}, not {dimension}", -1)
    contacts = tokens.whole("the number of contacts", least=1)
    rows = DIMENSION * contacts
    first = _take_matrix(tokens, "W or M")
    # A local file has exactly q and mu left; H alone is longer.
    local = tokens.left - DIMENSION * contacts - contacts in (0, 1)
    if not local and _is_matrix(tokens, first.shape[0], rows):
        return _finish_global(tokens, contacts, first)
    if first.shape != (rows, rows):
        raise tokens.wrong(
            f"expected W with {rows} rows and columns, or M and then H with {first.shape[0]} rows "
            f"and {rows} columns; W is {first.shape[0]} by {first.shape[1]}"
        )
    q = tokens.numbers(rows, "q")
    mu = _take_mu(tokens, contacts)
    return problem_of(first, q, mu)


def _finish_global(tokens: Tokens, contacts: int, mass: Any) -> ContactProblem:
    directions = _take_matrix(tokens, "H")
    f = tokens.numbers(mass.shape[0], "f")
    w = tokens.numbers(DIMENSION * contacts, "w")
    mu = _take_mu(tokens, contacts)
    return reduce_to_contacts(tokens.file, mass, directions, f, w, mu)


def _is_matrix(tokens: Tokens, rows: int, columns: int) -> bool:
    coming = tokens.peek(3)
    return coming[1:] == [str(rows), str(columns)] and coming[0] in ("0", "1", "2")


def _take_mu(tokens: Tokens, contacts: int) -> np.ndarray:
    mu = tokens.numbers(contacts, "mu")
    if mu.min() < 0.0:
        raise tokens.wrong("expected mu, at least 0", int(np.argmax(mu < 0.0)) - contacts)
    if tokens.left > 1:
        raise tokens.wrong(f"expected the end after mu, there are {tokens.left} words more")
    return mu


def _take_matrix(tokens: Tokens, name: str) -> Any:
    """Take a matrix of any storage; returns a sparse one."""
    storage = tokens.whole(f"the storage of {name} (0 dense, 1 block, 2 sparse)")
    if storage >= len(STORAGES):
        raise tokens.wrong(f"expected the storage of {name}: 0 dense, 1 block, 2 sparse", -1)
    shape = _take_shape(tokens, name)
    matrix = (_take_dense, _take_blocks, _take_sparse)[storage](tokens, name, shape)
    return matrix


def _take_shape(tokens: Tokens, name: str) -> tuple[int, int]:
    return (
        tokens.whole(f"the rows of {name}", least=1),
        tokens.whole(f"the columns of {name}", least=1),
    )


def _take_dense(tokens: Tokens, name: str, shape: tuple[int, int]) -> Any:
    if _take_shape(tokens, name) != shape:
        raise tokens.wrong(f"expected the size of {name} again, {shape[0]} {shape[1]}", -2)
    numbers = tokens.numbers(shape[0] * shape[1], f"the entries of {name}")
    return sparse.coo_matrix(numbers.reshape(shape, order="F"))


def _take_blocks(tokens: Tokens, name: str, shape: tuple[int, int]) -> Any:
    count = tokens.whole(f"the number of blocks of {name}")
    if count == 0:  # then nothing more of the matrix follows
        return sparse.coo_matrix(shape)
    sides = (
        tokens.whole(f"the rows of blocks of {name}", least=1),
        tokens.whole(f"the columns of blocks of {name}", least=1),
    )
    ends = [_take_ends(tokens, name, *each) for each in zip(sides, shape, strict=True)]
    # f1 may be short: rows of blocks after the last that has any are left out.
    f1 = tokens.whole(f"the rows of {name} that have blocks, and one", least=1)
    f2 = tokens.whole(f"the number of blocks of {name} again")
    if f2 != count:
        raise tokens.wrong(f"expected the {count} blocks of {name} again", -1)
    if f1 > sides[0] + 1:
        raise tokens.wrong(f"expected at most {sides[0] + 1} places of {name}'s rows of blocks", -2)
    first = tokens.wholes(f1, f"where the rows of blocks of {name} begin")
    if first[0] != 0 or first[-1] != count or (np.diff(first) < 0).any():
        raise tokens.wrong(
            f"expected {name}'s rows of blocks to begin at 0 and end at {count}", -f1
        )
    column = tokens.wholes(f2, f"the columns of the blocks of {name}")
    if column.max() >= sides[1]:
        bad = int(np.argmax(column >= sides[1]))
        raise tokens.wrong(f"expected columns of blocks of {name} below {sides[1]}", bad - f2)
    row = np.repeat(np.arange(f1 - 1), np.diff(first))
    return _take_entries_of_blocks(tokens, name, shape, ends, (row, column))


def _take_ends(tokens: Tokens, name: str, sides: int, size: int) -> np.ndarray:
    ends = tokens.wholes(sides, f"where the blocks of {name} end")
    if ends[-1] != size or ends[0] < 1 or (np.diff(ends) < 1).any():
        raise tokens.wrong(f"expected ends of blocks of {name} that ascend to {size}", -sides)
    return ends


def _take_entries_of_blocks(
    tokens: Tokens,
    name: str,
    shape: tuple[int, int],
    ends: list[np.ndarray],
    places: tuple[np.ndarray, np.ndarray],
) -> Any:
    starts = [np.concatenate([[0], each[:-1]]) for each in ends]
    rows, columns, values = [], [], []
    for number, (i, j) in enumerate(zip(*places, strict=True)):
        if tokens.whole(f"the number of a block of {name}") != number:
            raise tokens.wrong(f"expected block {number} of {name}", -1)
        height, width = ends[0][i] - starts[0][i], ends[1][j] - starts[1][j]
        values.append(tokens.numbers(int(height * width), f"block {number} of {name}"))
        rows.append(starts[0][i] + np.tile(np.arange(height), width))
        columns.append(starts[1][j] + np.repeat(np.arange(width), height))
    return sparse.coo_matrix(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=shape
    )


def _take_sparse(tokens: Tokens, name: str, shape: tuple[int, int]) -> Any:
    origin = tokens.whole(f"the origin of {name} (1 triplet, 2 by columns, 3 by rows)")
    if origin not in (TRIPLET, BY_COLUMNS, BY_ROWS):
        raise tokens.wrong(f"expected the origin of {name}: 1, 2 or 3", -1)
    count = _take_header(tokens, name, shape, origin)
    i, j, values = (
        _take_triplets(tokens, name, count)
        if origin == TRIPLET
        else _take_listing(tokens, name, count)
    )
    row, column = (j, i) if origin == BY_ROWS else (i, j)
    for index, size, what in ((row, shape[0], "rows"), (column, shape[1], "columns")):
        if count and (index.min() < 0 or index.max() >= size):
            bad = int(np.argmax((index < 0) | (index >= size)))
            raise tokens.wrong(
                f"expected {what} of {name} below {size}, entry {bad} has {index[bad]}; the matrix "
                "ends here"
            )
    return sparse.coo_matrix((values, (row, column)), shape=shape)


def _take_header(tokens: Tokens, name: str, shape: tuple[int, int], origin: int) -> int:
    """Skip the banner, check the header; returns the number of entries."""
    banner = tokens.peek(LONGEST_BANNER)
    place = next((at for at, word in enumerate(banner) if SHAPE.match(word)), None)
    if place is None:
        raise tokens.wrong(f"expected {name}'s listing by CSparse with {shape[0]}-by-{shape[1]}")
    for _ in range(place):
        tokens.word()
    triplet = place > 0 and banner[place - 1] == "triplet"
    if triplet != (origin == TRIPLET):
        expected = "a triplet listing" if origin == TRIPLET else "a compressed listing"
        raise tokens.wrong(f"expected {expected} of {name}, as its origin {origin} requires")
    if SHAPE.match(tokens.word()).groups() != (str(shape[0]), str(shape[1])):  # type: ignore[union-attr]
        raise tokens.wrong(f"expected the size of {name} again, {shape[0]}-by-{shape[1]}", -1)
    header: dict[str, str] = {}
    for key in ("nzmax", "nnz", "1-norm"):
        if tokens.peek(1) == [key]:
            tokens.word()
            header[key] = tokens.word().rstrip(",")
    if not header.get("nnz", "").isdigit():
        raise tokens.wrong(f"expected the number of entries of {name}, as nnz: and a whole number")
    return int(header["nnz"])


def _take_triplets(
    tokens: Tokens, name: str, count: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    places, values = tokens.entries(count, 2, f"the {count} entries of {name}, row, column, value")
    return places[:, 0], places[:, 1], values


def _take_listing(
    tokens: Tokens, name: str, count: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Take `col j : locations a to b` and the entries below it, until all were taken."""
    minor, major = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    values = [np.zeros(0)]
    column = -1
    taken = 0
    while tokens.peek(1) in (["col"], ["row"]):
        tokens.word()
        column = tokens.whole(f"a column of {name} after column {column}", least=column + 1)
        tokens.word()
        first = tokens.whole(f"the first entry of column {column} of {name}")
        tokens.word()
        past = tokens.whole(f"the last entry of column {column} of {name}", least=-1) + 1
        if first != taken or past < first or past > count:
            raise tokens.wrong(
                f"expected entries of {name} that follow {taken} and stay below {count}", -1
            )
        what = f"the entries of column {column} of {name}, row and value"
        places, found = tokens.entries(past - first, 1, what)
        minor.append(places[:, 0])
        major.append(np.full(past - first, column, dtype=np.int64))
        values.append(found)
        taken = past
    if taken != count:
        raise tokens.wrong(f"expected {count} entries of {name}, {taken} are listed")
    return np.concatenate(minor), np.concatenate(major), np.concatenate(values)
