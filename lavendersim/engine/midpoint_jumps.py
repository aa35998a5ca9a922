"""Contacts of bodies whose velocity jumps have no middle of the step (`effects.contact_midpoint`).

A row at the middle asks that its surfaces keep their distance in the mean of the velocities at both
ends, since that is what carries the bodies. Where another contact makes the velocity of a body jump
it is carried by the velocity of the end (`integrate.make_classify`), and with it what it pushes: a
row that asked for the mean would lift such a body by b dt, against its weight and for nothing. So
all rows of what jumps are those of the start.
"""

from __future__ import annotations

from typing import Any

from .compile import kernel
from .row_terms import make_acts, row_terms
from .spec import Spec


def make_carry_along(spec: Spec) -> Any:
    """Return `kernel(contacts, count, motion) -> whether a row more is to be that of the start`.

    Of contacts that are solved, `lasts` and `jumps` as they were then.
    """
    springs, acts = row_terms(spec).elastic, make_acts(spec)

    def spread(contacts, count, motion):
        # What is pushed by a body that jumps, jumps with it.
        again = True
        while again:
            again = False
            for c in range(count):
                contact = contacts[c]
                if acts(contact) and contact.inv_m_a > 0.0 and contact.inv_m_b > 0.0:
                    a, b = motion[contact.a], motion[contact.b]
                    if a.jumps != b.jumps:
                        a.jumps, b.jumps, again = 1, 1, True

    spread = kernel(spread, spec)

    def carry_along(contacts, count, motion):
        for i in range(motion.shape[0]):
            motion[i].jumps = 0
        abrupt = False
        for c in range(count):
            contact = contacts[c]
            if acts(contact) and contact.lasts == 0:
                abrupt = True
                if contact.inv_m_a > 0.0:
                    motion[contact.a].jumps = 1
                if contact.inv_m_b > 0.0:
                    motion[contact.b].jumps = 1
        if not abrupt:
            return False
        spread(contacts, count, motion)
        more = False
        for c in range(count):
            contact = contacts[c]
            if contact.lasts == 0:
                continue
            if springs:
                if contact.spring_compliance > 0.0:  # its force has no jump
                    continue
            if motion[contact.a].jumps == 1 or motion[contact.b].jumps == 1:
                contact.jumps, more = 1, True
        return more

    return kernel(carry_along, spec)
