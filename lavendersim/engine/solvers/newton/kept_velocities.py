"""Velocities that were kept beside impulses, for where impulses far larger are taken back.

Rows that no velocities meet, as of a body that two others press on, have no least: each stiffer
round of Newton's method has impulses as much larger, to 1e9 N s beside 10. Taken back, they leave
their last digits in the velocities, which then are no sum of impulses. Where that is more than
LOST of what moves, velocities are those that were kept; or those, and what impulses have changed by
since.
"""

from __future__ import annotations

from typing import Any

from ...compile import kernel
from ...contact import make_normal_velocity
from ...spec import Spec
from ...step_terms import step_terms

# Of `Envelope.kept`: at the start of the round, of the best impulses so far, and as `begin_again`
# found them.
OF_START, OF_BEST, OF_BEFORE = range(3)
PLACES = 3
# How many times as fast as all else the impulses of a round are that leave their digits [-]. Each
# that is taken back leaves 2^-53 of it: of faster ones the rounds of a solve would leave more than
# 1e-9 of what moves.
LOST = 2.0**20


def make_keep_velocities(spec: Spec) -> Any:
    """Return `kernel(velocities, workspace, size, place)`: keep those of the bodies laid out."""
    turns = step_terms(spec).turns

    def keep_velocities(velocities, workspace, size, place):
        for p in range(size):
            v, kept = velocities[workspace.visited[p]], workspace.kept[place, p]
            kept[0], kept[1], kept[2] = v.vx, v.vy, v.vz
            if turns:
                kept[3], kept[4], kept[5] = v.wx, v.wy, v.wz

    return kernel(keep_velocities, spec)


def make_put_velocities(spec: Spec) -> Any:
    """Return `kernel(velocities, workspace, size, place)`: velocities as they were kept."""
    turns = step_terms(spec).turns

    def put_velocities(velocities, workspace, size, place):
        for p in range(size):
            v, kept = velocities[workspace.visited[p]], workspace.kept[place, p]
            v.vx, v.vy, v.vz = kept[0], kept[1], kept[2]
            if turns:
                v.wx, v.wy, v.wz = kept[3], kept[4], kept[5]

    return kernel(put_velocities, spec)


def make_speed(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities) -> speed`: of normals, and of impulses [m/s]."""
    normal_velocity = make_normal_velocity(spec)

    def speed(contacts, count, velocities):
        most = 0.0
        for c in range(count):
            contact = contacts[c]
            v = normal_velocity(contact, velocities[contact.a], velocities[contact.b])
            most = max(most, abs(v), contact.k_n * abs(contact.lambda_n))
        return most

    return kernel(speed, spec)
