"""Impacts of bodies that joints join: all of them have theirs at one time of the step."""

from __future__ import annotations

from typing import Any

from .compile import kernel
from .spec import Spec


def make_share_impacts(spec: Spec) -> Any:
    """Return `kernel(contacts, count, motion)`: bodies that joints join have their impact at once.

    Each moves on the velocities before it up to the first of theirs, or their joint would tear.
    """

    def share_impacts(contacts, count, motion):
        again = True
        while again:
            again = False
            for c in range(count):
                contact = contacts[c]
                if contact.bilateral == 1 and contact.inv_m_a > 0.0 and contact.inv_m_b > 0.0:
                    a, b = motion[contact.a], motion[contact.b]
                    if a.tau != b.tau:
                        a.tau = b.tau = min(a.tau, b.tau)
                        again = True

    return kernel(share_impacts, spec)
