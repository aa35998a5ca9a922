"""The impulses that explain a change of momentum best: least squares over a product of cones.

    least |b - G^T r|^2   over r_c in K_c for every contact c
Rows of G are what a unit of impulse gives to the bodies, columns of bodies scaled so that squares
are twice kinetic energies. Nothing is asked of velocities: this is no contact problem (there is no
De Saxce shift, and K may be more than Coulomb's cone), and its answer is unique in G^T r whatever
redundant contacts share. A proximal point iteration on r,
    r^k+1 = P_K(r^k + G z / softness),   F(z) = z - b + G^T P_K(r^k + G z / softness) = 0,
each F the gradient of a strongly convex function of z, which becomes what is left. With the root L
of the projection's derivative (`friction_cone`) a step solves
    (1 + (L^T G)^T (L^T G) / softness) dz = -F
of the size of the bodies, however many contacts there are, and halves it until the function falls.

Where redundant contacts leave impulses open a cost u . r, u in the dual cone, chooses among them:
rounds with ever less of it, then without any, so that it takes nothing from the fit.

y is as large as z / softness, and P(y) no more exact than that: 1e-11 where much is left. Last
rounds of a larger softness, which would be slow from afar, take this from impulses that fit.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final, Literal, NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from lavendersim.problems.friction_cone import derivative_root, project

# What impulses may be: inside Coulomb's cone, pushes with any tangents, or anything.
Allowed = Literal["cone", "push", "any"]

SOFTNESS: Final = 1e-5  # beside the contacts' own scale, 1: what redundant contacts need [-]
LAST_SOFTNESS: Final = 1e-2
ROUNDS, LAST_ROUNDS, STEPS, HALVINGS = 40, 3, 60, 30
# Shares of a cost that rounds begin with: the impulses it moves from their fit are as small [-].
COSTS: Final = (1e-2, 1e-4)
ROUNDS_OF_A_COST: Final = 10
# Of |b|: a change of what is left that ends the rounds, and what a round may leave of F [-].
ROUND_OFF: Final = 1e-15
LARGEST_DENSE: Final = 240  # columns up to which a dense factorisation is the faster [-]


class Fit(NamedTuple):
    """The impulses that explain most, and what they leave."""

    impulses: np.ndarray  # (n, 3), each in its cone
    left: np.ndarray  # (columns,) b - G^T r


class _Rows(NamedTuple):
    """G by contacts, each scaled to 1."""

    dense: np.ndarray | None  # (n, 3, columns)
    matrix: Any  # (3n, columns), scipy's or numpy's
    scale: np.ndarray  # (n,) impulse of a unit
    mu: np.ndarray
    allowed: Allowed

    def given(self, x: np.ndarray) -> np.ndarray:
        """Return G^T x."""
        given: np.ndarray = self.matrix.T @ x.ravel()
        return given

    def along(self, z: np.ndarray) -> np.ndarray:
        """Return G z by contacts, (n, 3)."""
        along: np.ndarray = (self.matrix @ z).reshape(-1, 3)
        return along

    def project(self, y: np.ndarray) -> np.ndarray:
        """Return the nearest impulses that are allowed."""
        if self.allowed == "cone":
            return project(y, self.mu)
        if self.allowed == "any":
            return y
        pushes = y.copy()
        pushes[:, 0] = np.maximum(y[:, 0], 0.0)
        return pushes

    def root(self, y: np.ndarray) -> np.ndarray:
        """Return L of the projection's derivative L L^T, (n, 3, 3)."""
        if self.allowed == "cone":
            return derivative_root(y, self.mu)
        root = np.tile(np.eye(3), (len(y), 1, 1))
        if self.allowed == "push":
            root[y[:, 0] < 0.0, 0, 0] = 0.0
        return root

    def step(self, y: np.ndarray, F: np.ndarray, softness: float) -> np.ndarray:
        """Return dz."""
        root = self.root(y)
        if self.dense is not None:
            B = np.matmul(root.transpose(0, 2, 1), self.dense).reshape(-1, len(F))
            B = B[B.any(axis=1)]
            solved: np.ndarray = np.linalg.solve(B.T @ B / softness + np.eye(len(F)), -F)
            return solved
        count = len(root)
        L = sparse.bsr_matrix((root, np.arange(count), np.arange(count + 1)))
        B = (L.T @ self.matrix).tocsr()
        system = B.T @ B / softness + sparse.identity(len(F))
        found: np.ndarray = splu(system.tocsc()).solve(-F)
        return found


def fit_impulses(
    G: Any,
    b: np.ndarray,
    mu: np.ndarray,
    allowed: Allowed = "cone",
    cost: np.ndarray | None = None,
) -> Fit:
    """Return the fit. G: (3n, columns), numpy's or scipy's, rows n, t1, t2 of each contact in turn.

    b: (columns,); mu: (n,), used by `cone`; cost: u (n, 3), of any scale. A contact that gives
    nothing gets no impulse.
    """
    size = float(np.linalg.norm(b))
    if size == 0.0 or len(mu) == 0:
        return Fit(np.zeros((len(mu), 3)), b.copy())
    rows = _scaled(G, mu, allowed)
    x, z = np.zeros((len(mu), 3)), b / size
    goal = z
    for push, softness, rounds in _stages(rows, cost):
        for _ in range(rounds):
            before = z
            z, x = _round(rows, goal, x - push, z, softness)
            change = float(np.linalg.norm(z - before))
            if change <= ROUND_OFF * (1.0 + float(np.linalg.norm(before))):
                break
    x = x * (rows.scale * size)[:, None]
    return Fit(x, b - np.asarray(G.T @ x.ravel()))


def impulse_matrix(values: np.ndarray, place: np.ndarray, columns: int) -> Any:
    """Return G (3m, columns) of contacts that give to two bodies: dense where it has few columns.

    values: (m, 2, 3, 6) of an impulse along n, t1, t2 to each; place: (m, 2) which six columns are
    the body's, in sixes; below 0 it has none.
    """
    point, side = np.nonzero(place >= 0)
    row = 3 * point[:, None, None] + np.arange(3)[None, :, None]
    column = 6 * place[point, side][:, None, None] + np.arange(6)[None, None, :]
    row, column = (np.broadcast_to(one, (len(point), 3, 6)).ravel() for one in (row, column))
    entries, shape = values[point, side].ravel(), (3 * len(values), columns)
    if columns > LARGEST_DENSE:
        return sparse.csr_matrix((entries, (row, column)), shape=shape)
    matrix = np.zeros(shape)
    matrix[row, column] = entries
    return matrix


def _stages(rows: _Rows, cost: np.ndarray | None) -> Iterator[tuple[np.ndarray, float, int]]:
    """Yield by how much costs move the centre of a round, its softness, and rounds at most."""
    if cost is not None:
        own = cost * rows.scale[:, None]
        largest = float(np.abs(own).max())
        if largest > 0.0:
            for share in COSTS:
                yield share * own / (largest * SOFTNESS), SOFTNESS, ROUNDS_OF_A_COST
    nothing = np.zeros((len(rows.mu), 3))
    yield nothing, SOFTNESS, ROUNDS
    yield nothing, LAST_SOFTNESS, LAST_ROUNDS


def _scaled(G: Any, mu: np.ndarray, allowed: Allowed) -> _Rows:
    squares = np.asarray(G.multiply(G).sum(axis=1) if sparse.issparse(G) else (G * G).sum(axis=1))
    own = squares.reshape(-1, 3).sum(axis=1) / 3.0
    scale = np.where(own > 0.0, 1.0 / np.sqrt(np.where(own > 0.0, own, 1.0)), 0.0)
    if G.shape[1] <= LARGEST_DENSE:
        full = np.asarray(G.toarray() if sparse.issparse(G) else G, float)
        dense = full.reshape(len(mu), 3, -1) * scale[:, None, None]
        return _Rows(dense, dense.reshape(full.shape), scale, mu, allowed)
    matrix = sparse.diags(np.repeat(scale, 3)) @ sparse.csr_matrix(G)
    return _Rows(None, matrix.tocsr(), scale, mu, allowed)


def _round(
    rows: _Rows, b: np.ndarray, x: np.ndarray, z: np.ndarray, softness: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return z where F = 0 around the impulses x, and the impulses there."""
    y = x + rows.along(z) / softness
    pushed = rows.project(y)
    F = z - b + rows.given(pushed)
    before = math.inf
    for _ in range(STEPS):
        off = float(np.linalg.norm(F))
        # y is as exact as its size lets it be, F as y: where a step gains nothing there, none will.
        if off <= ROUND_OFF or 0.5 * before <= off <= ROUND_OFF * float(np.linalg.norm(y)):
            break
        before = off
        dz = rows.step(y, F, softness)
        slope, dy = float(F @ dz), rows.along(dz) / softness
        length = 1.0
        value = _value(z, b, pushed, softness)
        for _ in range(HALVINGS):
            there = z + length * dz
            at = rows.project(y + length * dy)
            F = there - b + rows.given(at)
            if float(np.linalg.norm(F)) < 0.5 * off:
                break
            if _value(there, b, at, softness) <= value + 1e-4 * length * slope:
                break
            length *= 0.5
        else:
            break  # round-off: no step is any better
        if length * float(np.linalg.norm(dz)) == 0.0:
            break
        z, y, pushed = there, y + length * dy, at
    # What the impulses leave, not z, which is that but for round-off of large impulses.
    return b - rows.given(pushed), pushed


def _value(z: np.ndarray, b: np.ndarray, pushed: np.ndarray, softness: float) -> float:
    """Return the convex function of which F is the gradient; of a cone (P(y)^2)' is 2 P(y)."""
    return float(0.5 * z @ z - b @ z + 0.5 * softness * np.vdot(pushed, pushed))
