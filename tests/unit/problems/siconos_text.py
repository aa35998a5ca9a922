"""Matrices in, their text in each storage of Siconos' files out, as its writer prints them."""

from __future__ import annotations

import numpy as np
from scipy import sparse

BANNER = "CSparse Version 3.1.9, May 4, 2016.  Copyright (c) Timothy A. Davis, 2006-2016"
STORAGES = ("dense", "block", "triplet", "by columns", "by rows")


def numbers(values: np.ndarray) -> str:
    """Return numbers on one line; 17 digits are all of a float64."""
    return "".join(f"{value:32.24e} " for value in np.ravel(values)) + "\n"


def matrix_text(matrix: np.ndarray, storage: str, sides: tuple[int, int] = (3, 3)) -> str:
    """Return a full matrix in a storage; `sides` is the size of its blocks."""
    rows, columns = matrix.shape
    if storage == "dense":
        return f"0\n{rows}\n{columns}\n{rows}\t{columns}\n" + numbers(matrix.T)
    if storage == "block":
        return f"1\n{rows}\n{columns}\n" + _blocks(matrix, *sides)
    return f"2\n{rows}\n{columns}\n" + _listing(matrix, storage)


def _blocks(matrix: np.ndarray, height: int, width: int) -> str:
    rows, columns = matrix.shape[0] // height, matrix.shape[1] // width
    ends = (height * np.arange(1, rows + 1), width * np.arange(1, columns + 1))
    begin, column, text = [0], [], ""
    for i in range(rows):
        for j in range(columns):
            part = matrix[height * i : height * (i + 1), width * j : width * (j + 1)]
            if part.any():
                text += f"{len(column)}\n" + "".join(f"{x:32.24e}\n" for x in part.T.ravel())
                column.append(j)
        begin.append(len(column))
    head = [[len(column)], [rows], [columns], *ends, [len(begin)], [len(column)], begin, column]
    return "".join("\t".join(str(x) for x in line) + "\n" for line in head) + text


def _listing(matrix: np.ndarray, storage: str) -> str:
    shape = f"{matrix.shape[0]}-by-{matrix.shape[1]}"
    if storage == "triplet":
        table = sparse.coo_matrix(matrix)
        text = f"1\n{BANNER}\ntriplet: {shape}, nzmax: {2 * table.nnz} nnz: {table.nnz}\n"
        entries = zip(table.row, table.col, table.data, strict=True)
        return text + "".join(f"    {i} {j} : {x:.17g}\n" for i, j, x in entries)
    by_columns = storage == "by columns"
    table = sparse.csc_matrix(matrix) if by_columns else sparse.csr_matrix(matrix)
    text = f"{2 if by_columns else 3}\n{BANNER}\n"
    text += f"{shape}, nzmax: {table.nnz} nnz: {table.nnz}, 1-norm: {abs(matrix).sum():g}\n"
    for j in range(len(table.indptr) - 1):
        first, past = table.indptr[j : j + 2]
        text += f"    col {j} : locations {first} to {past - 1}\n"
        for i, x in zip(table.indices[first:past], table.data[first:past], strict=True):
            text += f"      {i} : {x:.17g}\n"
    return text
