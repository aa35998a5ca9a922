"""The contact problem of a step, assembled from its contacts and the velocities before impulses.

Of contact c with bodies A and B, in its frame (n, t1, t2) of unit vectors f_i,
    u_i = f_i . (v_B - v_A) + (r_B x f_i) . omega_B - (r_A x f_i) . omega_A
    W_cd[i, j] = sum over the movable bodies k that c and d share, with signs -1 on A and +1 on B,
        s_c s_d (f_ci . f_dj / m_k + (r_ck x f_ci) . I_k^-1 (r_dk x f_dj))
Speculative contacts are rows like the others: the solver sees them so. Surfaces that
move by themselves add their velocity to `free`.

A frictionless contact has no tangential impulse. Without any friction an engine knows no lever and
no inertia for its tangents: these rows then are those of bodies that do not turn. With mu = 0 no
impulse and no normal velocity depends on them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .contact_problem import ContactProblem
from .row_terms import row_terms
from .spec import Spec
from .tangents import first_tangent, second_tangent


class StepProblem(NamedTuple):
    """A step's problem and its engine's solution."""

    problem: ContactProblem
    impulses: np.ndarray  # (n, 3) [N s] of the step's last solve, on B along n, t1, t2


class _Side(NamedTuple):
    """What the contacts are to one of their two bodies; n contacts."""

    body: np.ndarray  # (n,) row
    sign: float  # of the impulse on it
    inv_m: np.ndarray  # (n,) [1/kg]
    levers: np.ndarray  # (n, 3, 3) [m] r x f_i
    turns: np.ndarray  # (n, 3, 3) [1/(kg m)] inverse inertia times that


def step_problem(spec: Spec, contacts: np.ndarray, velocities: np.ndarray) -> StepProblem:
    """Return the problem of completed contacts (n,); velocities: (bodies,) before any impulse."""
    frames, terms = _frames(spec, contacts), row_terms(spec)
    sides = [_side(spec, contacts, velocities, frames, body) for body in "ab"]
    begin, row, blocks = _delassus(sides, frames)
    frictional = _frictional(spec, contacts)
    if terms.yielding:  # of the contact itself, as gamma is of its normal
        own = row == np.repeat(np.arange(len(contacts)), np.diff(begin))
        at = np.flatnonzero(own)
        for axis in (1, 2):
            blocks[at, axis, axis] += contacts["gamma_t"][row[at]]
    free = np.zeros((len(contacts), 3))
    for side in sides:
        linear, angular = _velocity_of(velocities, side.body)
        along = np.einsum("cik,ck->ci", frames, linear)
        free += side.sign * (along + np.einsum("cik,ck->ci", side.levers, angular))
    if terms.frictional and terms.shifted:
        free[:, 1:] += frictional[:, None] * _columns(contacts, "surface_1", "surface_2")
    problem = ContactProblem(
        begin,
        row,
        blocks,
        free,
        frictional * contacts["mu"] if terms.frictional else np.zeros(len(contacts)),
        contacts["gamma"].copy() if terms.compliant else np.zeros(len(contacts)),
        contacts["target"].copy(),
    )
    return StepProblem(problem, _impulses(spec, contacts))


def _columns(rows: np.ndarray, *names: str) -> np.ndarray:
    return np.stack([rows[name] for name in names], axis=-1)


def _vectors(rows: np.ndarray, name: str) -> np.ndarray:
    return _columns(rows, *(f"{name}{axis}" for axis in "xyz"))


def _frictional(spec: Spec, contacts: np.ndarray) -> np.ndarray:
    """Return 1.0 for contacts with friction, 0.0 for the others."""
    terms = row_terms(spec)
    if not terms.frictional:
        return np.zeros(len(contacts))
    if not terms.frictionless:
        return np.ones(len(contacts))
    return contacts["frictional"].astype(np.float64)


def _frames(spec: Spec, contacts: np.ndarray) -> np.ndarray:
    """Return n, t1, t2 of each contact as rows, (n, 3, 3); as `block.set_tangents` does."""
    normal = _vectors(contacts, "n")
    if row_terms(spec).frictional:
        return np.stack([normal, _vectors(contacts, "t1"), _vectors(contacts, "t2")], axis=1)
    x, y, z = normal.T
    side = np.where(z >= 0.0, 1.0, -1.0)
    one = np.stack(first_tangent(x, y, z, side), axis=-1)
    two = np.stack(second_tangent(x, y, z, side), axis=-1)
    return np.stack([normal, one, two], axis=1)


def _side(
    spec: Spec, contacts: np.ndarray, velocities: np.ndarray, frames: np.ndarray, name: str
) -> _Side:
    body = contacts[name].astype(np.int64)
    levers, turns = np.zeros_like(frames), np.zeros_like(frames)
    terms = row_terms(spec)
    if terms.frictional:
        levers = np.cross(_vectors(contacts, f"r{name}")[:, None, :], frames)
        if terms.coupled:
            turned = np.einsum("cil,cl->ci", frames, _vectors(contacts, "patch_"))
            levers = levers + turned[:, :, None] * _vectors(contacts, "n")[:, None, :]
        turns = np.einsum("ckl,cil->cik", _inverse_inertia(velocities[body]), levers)
    if terms.levers and terms.frictionless:
        frictionless = _frictional(spec, contacts) == 0.0
        levers[frictionless, 0] = _vectors(contacts, f"lever_{name}")[frictionless]
        turns[frictionless, 0] = _vectors(contacts, f"turn_{name}")[frictionless]
    return _Side(body, 1.0 if name == "b" else -1.0, contacts[f"inv_m_{name}"], levers, turns)


def _inverse_inertia(velocities: np.ndarray) -> np.ndarray:
    xx, xy, xz, yy, yz, zz = (velocities[f"j{n}"] for n in ("xx", "xy", "xz", "yy", "yz", "zz"))
    return np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=-1).reshape(-1, 3, 3)


def _velocity_of(velocities: np.ndarray, body: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    linear = _vectors(velocities, "v")[body]
    turning = "wx" in (velocities.dtype.names or ())
    return linear, _vectors(velocities, "w")[body] if turning else np.zeros_like(linear)


def _delassus(sides: list[_Side], frames: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return begin, row and blocks of W, see `ContactProblem`."""
    count = len(frames)
    # Every (contact, movable body) once, in the order of the bodies.
    body = np.concatenate([side.body for side in sides])
    movable = np.concatenate([side.inv_m for side in sides]) > 0.0
    entries = np.flatnonzero(movable)
    entries = entries[np.argsort(body[entries], kind="stable")]
    body, contact = body[entries], entries % count
    sign = np.repeat([side.sign for side in sides], count)[entries]
    inv_m = np.concatenate([side.inv_m for side in sides])[entries]
    levers = np.concatenate([side.levers for side in sides])[entries]
    turns = np.concatenate([side.turns for side in sides])[entries]
    # Every pair of entries of one body.
    _, first, group, size = np.unique(
        body, return_index=True, return_inverse=True, return_counts=True
    )
    mates = size[group]
    one = np.repeat(np.arange(len(body)), mates)
    place = np.arange(len(one)) - np.repeat(np.cumsum(mates) - mates, mates)
    other = first[group][one] + place
    across = np.einsum("pik,pjk->pij", frames[contact[one]], frames[contact[other]])
    about = np.einsum("pik,pjk->pij", levers[one], turns[other])
    shares = (sign[one] * sign[other])[:, None, None] * (inv_m[one, None, None] * across + about)
    # Contacts that share both bodies have one block.
    columns, at = np.unique(contact[other] * count + contact[one], return_inverse=True)
    blocks = np.zeros((len(columns), 3, 3))
    np.add.at(blocks, at, shares)
    column, row = np.divmod(columns, count)
    return np.searchsorted(column, np.arange(count + 1)), row, blocks


def _impulses(spec: Spec, contacts: np.ndarray) -> np.ndarray:
    if row_terms(spec).frictional:
        return _columns(contacts, "lambda_n", "lambda_1", "lambda_2")
    impulses = np.zeros((len(contacts), 3))
    impulses[:, 0] = contacts["lambda_n"]
    return impulses
