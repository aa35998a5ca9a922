"""A bound on W, contact by contact, by Cauchy and Schwarz: how far all contacts may step at once.

W = sum over bodies of J_b M_b^-1 J_b^T. A body's term, with blocks X_i X_j^T, is at most the
diagonal of n_b |X_i|^2, n_b the number of its contacts (Cauchy and Schwarz); so W is at most
    diag(n_i |W_ii|),   n_i the larger number of contacts of the contact's two bodies,
as if each body were split among its contacts. Of a problem given by its matrix, rows of blocks are
summed up instead (`matrix_problem`).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..compile import kernel
from ..row_terms import row_terms
from ..spec import Spec

CONTACT_FIELDS = [("bound", "f8")]  # [1/kg]


def allocate(spec: Spec, bodies: int, contacts: int) -> np.ndarray:
    """Return the counts of contacts by body."""
    return np.zeros(bodies, np.int64)


def make_bound(spec: Spec) -> Any:
    """Return `kernel(contacts, count, touching)` that fills `bound`; touching: (bodies,) counts."""
    terms = row_terms(spec)
    friction, compliant, yielding = terms.frictional, terms.compliant, terms.yielding

    def bound_by_matrix(contacts, count, touching):
        pass  # filled with the records

    if spec.operator == "matrix":
        return kernel(bound_by_matrix, spec)

    def bound(contacts, count, touching):
        for i in range(touching.shape[0]):
            touching[i] = 0
        for c in range(count):
            contact = contacts[c]
            touching[contact.a] += 1
            touching[contact.b] += 1
        for c in range(count):
            contact = contacts[c]
            most = 1
            if contact.inv_m_a > 0.0:
                most = touching[contact.a]
            if contact.inv_m_b > 0.0:
                most = max(most, touching[contact.b])
            stiffest = contact.k_n
            if friction:
                # Gershgorin's bound of the contact's own block.
                beside = abs(contact.k_n1) + abs(contact.k_n2)
                k_t = contact.k_t
                if yielding:
                    k_t -= contact.gamma_t
                stiffest = max(contact.k_n, k_t) + beside
            contact.bound = most * stiffest
            if compliant:
                contact.bound += contact.gamma
            if yielding:
                contact.bound += contact.gamma_t

    return kernel(bound, spec)
