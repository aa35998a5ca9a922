"""The contact problem of a step, given by its Delassus matrix, and a solver's solution of it.

    u = W r + free + target e_n,   w = u + gamma r_n e_n          per contact, frame (n, t1, t2)
    0 <= r_n  complementary to  w_n >= 0
    |r_t| <= mu r_n,  and where w_t is not 0:  r_t = -mu r_n w_t / |w_t|
r are impulses on B, u the velocity of B relative to A. W is the Delassus operator J M^-1 J^T, kept
by 3x3 blocks, column by column: W of files written by others need not be symmetric to the last
digit, and is solved as it stands.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class ContactProblem(NamedTuple):
    """n contacts, m stored blocks of W."""

    begin: np.ndarray  # (n + 1,) int64, where the blocks of a column start
    row: np.ndarray  # (m,) int64, block row, ascending within a column; the diagonal is stored
    blocks: np.ndarray  # (m, 3, 3) [1/kg] entry [i, j] maps impulse j of the column to velocity i
    free: np.ndarray  # (n, 3) [m/s] velocities without any impulse
    mu: np.ndarray  # (n,) [-]
    gamma: np.ndarray  # (n,) [1/kg] regularisation of the normal rows
    target: np.ndarray  # (n,) [m/s] added to the normal velocity

    @property
    def contacts(self) -> int:
        """How many contacts the problem has."""
        return len(self.mu)

    @property
    def columns(self) -> np.ndarray:
        """Block column of every stored block, (m,)."""
        return np.repeat(np.arange(self.contacts), np.diff(self.begin))

    @property
    def own_blocks(self) -> np.ndarray:
        """The contacts' own blocks of W, (n, 3, 3) [1/kg]."""
        blocks: np.ndarray = self.blocks[self.row == self.columns]
        return blocks

    @property
    def q(self) -> np.ndarray:
        """A copy of free + target e_n, (n, 3) [m/s]: u = (W + gamma) r + q."""
        q: np.ndarray = self.free.copy()
        q[:, 0] += self.target
        return q


class Solution(NamedTuple):
    """What a solver leaves."""

    impulses: np.ndarray  # (n, 3) [N s]
    sweeps: int  # sweeps, or steps of methods that make none
    history: np.ndarray  # (k,) `scaled` residual at the start and after every sweep; or empty
    status: str  # SOLVED, or why not
    scaled: float  # residual of `impulses`, see `problems.residual` [-]
    local: float  # the same with each contact's own scale [-]


SOLVED = "solved"
SPENT = "all sweeps spent"
NOT_FINITE = "no longer finite"
