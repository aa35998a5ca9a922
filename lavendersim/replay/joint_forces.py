"""One force for each joint, where a log has a row for each direction that the joint holds."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Rows = npt.NDArray[Any]


def has_joints(contact: Rows) -> bool:
    """Whether some rows are of joints."""
    return "joint" in (contact.dtype.names or ()) and bool((contact["joint"] > 0).any())


def with_whole_forces(contact: Rows) -> Rows:
    """Return rows of contacts in which a joint has one of a step: its force, where the joint is.

    The first of its rows stands for all; the others are left out.
    """
    if not has_joints(contact):
        return contact
    joined = np.flatnonzero(contact["joint"] > 0)
    own = contact[joined]
    # Rows of a joint in a step are one after the other, and rows are in the order of steps.
    begins = np.ones(len(own), bool)
    same = (own["joint"][1:] == own["joint"][:-1]) & (own["step"][1:] == own["step"][:-1])
    begins[1:] = ~same
    group = np.cumsum(begins) - 1
    forces = [np.bincount(group, own["force_n"] * own[f"n{axis}"]) for axis in "xyz"]
    size = np.sqrt(sum(one * one for one in forces))
    first = joined[begins]
    whole = contact.copy()
    whole["force_n"][first] = size
    for axis, one in zip("xyz", forces, strict=True):
        known = np.divide(one, size, out=np.array(whole[f"n{axis}"][first]), where=size > 0.0)
        whole[f"n{axis}"][first] = known
    kept = np.ones(len(contact), bool)
    kept[joined[~begins]] = False
    rows: Rows = whole[kept]
    return rows
