"""The matrix of Newton's method is M + J^T E J of dense algebra, on and below its diagonal."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import drawn, views
from interpreted import interpreted, records

from lavendersim.engine.compile import inner
from lavendersim.engine.solvers.newton.envelope import DOF, allocate_envelope, lay_out
from lavendersim.engine.solvers.newton.matrix import make_assemble
from lavendersim.engine.solvers.newton.minimise import make_assemble_mass
from lavendersim.engine.solvers.newton.response import Stiffness
from lavendersim.engine.spec import Spec

FRICTIONAL = Spec(effects=("friction", "newton", "rotation"), solver="adaptive")
FRICTIONLESS = Spec(effects=("contact_torque", "newton", "rotation"), solver="adaptive")
# A floor, a ring and a fork; A and B in either order, whichever comes first in the matrix.
ONE_WAY = [(0, 1), (1, 2), (3, 1), (3, 4), (2, 5), (1, 5)]
PAIRS = [*ONE_WAY, *((b, a) for a, b in ONE_WAY)]


@inner
def stiffness(contact):
    """Return a matrix of the contact's own numbers; none where it is open."""
    if contact.lambda_n == 0.0:
        return Stiffness(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    return Stiffness(
        3.0, contact.step_n, 0.5, 2.0 + contact.mu, 0.3, 4.0
    )  # positive definite for |step_n| < 1


@inner
def stiffness_of_normal(contact):
    """Return the same of a contact without friction."""
    return Stiffness(2.0 + contact.step_n if contact.lambda_n > 0.0 else 0.0, 0, 0, 0, 0, 0)


@pytest.mark.parametrize("spec", [FRICTIONAL, FRICTIONLESS], ids=["friction", "frictionless"])
def test_the_envelope_has_the_dense_matrix(spec: Spec, rng) -> None:
    scene = drawn(spec, rng, PAIRS)
    scene.contacts["step_n"] = rng.uniform(-0.9, 0.9, len(PAIRS))
    scene.contacts["lambda_n"][3] = 0.0
    frictional = spec is FRICTIONAL
    response = stiffness if frictional else stiffness_of_normal
    bodies, _, contacts = views(scene)
    workspace = records(allocate_envelope(6, len(PAIRS), 2000))
    workspace.values[:] = 7.0  # of the step before
    size, entries, _ = interpreted(lay_out)(contacts, len(PAIRS), workspace)
    interpreted(make_assemble_mass(spec))(bodies, size, workspace)
    interpreted(make_assemble(spec, response))(contacts, len(PAIRS), size, workspace)
    middle = np.zeros((3 * len(PAIRS), 3 * len(PAIRS)))
    for k, contact in enumerate(contacts):
        e = response.py_func(contact)
        middle[3 * k : 3 * k + 3, 3 * k : 3 * k + 3] = [
            [e.nn, e.n1, e.n2], [e.n1, e.t11, e.t12], [e.n2, e.t12, e.t22],
        ]  # fmt: skip
    whole = scene.mass + scene.jacobian.T @ middle @ scene.jacobian
    places = [DOF * int(i) + k for i in workspace.visited[:size] for k in range(DOF)]
    assert len(places) == DOF * 5
    dense = whole[np.ix_(places, places)]
    found = np.zeros_like(dense)
    for row in range(DOF * size):
        begin, at = DOF * workspace.first[row // DOF], workspace.start[row]
        found[row, begin : row + 1] = workspace.values[at : at + row - begin + 1]
    # Sums of some ten terms below 30.
    np.testing.assert_allclose(found, np.tril(dense), atol=1e-13)
    assert (workspace.values[entries:] == 7.0).all()
