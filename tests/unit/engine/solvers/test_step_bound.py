"""The diagonal of the bound is stiffer than W = J M^-1 J^T, built densely from the bodies."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted, records

from lavendersim.engine.record_layout import contact_dtype
from lavendersim.engine.solvers.step_bound import allocate, make_bound
from lavendersim.engine.spec import Spec

BODIES = 6
EFFECTS = {"normal": (), "compliant": ("compliance",), "block": ("friction",)}


class Contacts:
    """Contacts of points between random bodies, one of them fixed, without levers."""

    def __init__(self, rng, kind: str, count: int = 10) -> None:
        self.spec = Spec(EFFECTS[kind], (), "jacobi")
        self.rows = np.zeros(count, contact_dtype(self.spec))
        inverse = rng.uniform(0.2, 3.0, BODIES) * (np.arange(BODIES) > 0)
        axes = 3 if kind == "block" else 1
        jacobian = np.zeros((axes * count, 3 * BODIES))
        for c, row in enumerate(self.rows):
            a, b = rng.choice(BODIES, 2, replace=False)
            frame = np.linalg.qr(rng.normal(size=(3, 3)))[0][:axes]
            row["a"], row["b"] = a, b
            row["inv_m_a"], row["inv_m_b"] = inverse[a], inverse[b]
            row["k_n"] = inverse[a] + inverse[b]
            if kind == "block":
                row["k_t"] = row["k_n"]
            jacobian[axes * c : axes * (c + 1), 3 * a : 3 * a + 3] = -frame
            jacobian[axes * c : axes * (c + 1), 3 * b : 3 * b + 3] = frame
        self.matrix = jacobian @ np.diag(np.repeat(inverse, 3)) @ jacobian.T
        if kind == "compliant":
            self.rows["gamma"] = rng.uniform(0.0, 2.0, count)
            self.matrix += np.diag(self.rows["gamma"])
        touching = allocate(self.spec, BODIES, count)
        interpreted(make_bound(self.spec))(records(self.rows), count, touching)
        self.bound = np.repeat(self.rows["bound"], axes)
        self.touching = touching


@pytest.mark.parametrize("kind", EFFECTS)
def test_no_step_against_it_overshoots(kind: str, rng) -> None:
    for _ in range(10):
        found = Contacts(rng, kind)
        assert np.linalg.eigvalsh(np.diag(found.bound) - found.matrix)[0] >= -1e-12


def test_one_contact_alone_is_as_stiff_as_it_is_and_fixed_bodies_do_not_count(rng) -> None:
    """All contacts share the fixed body 0 and nothing else: each is alone."""
    found = Contacts(rng, "normal", 4)
    found.rows["a"], found.rows["b"] = 0, [1, 2, 3, 4]
    found.rows["inv_m_a"], found.rows["inv_m_b"] = 0.0, 2.0
    found.rows["k_n"] = 2.0
    interpreted(make_bound(found.spec))(records(found.rows), 4, found.touching)
    assert found.rows["bound"].tolist() == [2.0] * 4
    assert found.touching.tolist() == [4, 1, 1, 1, 1, 0]


def test_couplings_within_a_block_make_it_stiffer(rng) -> None:
    found = Contacts(rng, "block", 1)
    found.rows["inv_m_a"] = found.rows["inv_m_b"] = 1.0
    found.rows["k_n"], found.rows["k_t"] = 2.0, 3.0
    found.rows["k_n1"], found.rows["k_n2"] = -0.25, 0.5
    interpreted(make_bound(found.spec))(records(found.rows), 1, found.touching)
    block = np.array([[2.0, -0.25, 0.5], [-0.25, 3.0, 0.0], [0.5, 0.0, 3.0]])
    assert np.linalg.eigvalsh(block)[-1] <= found.rows["bound"][0] <= 3.75


def test_a_problem_by_its_matrix_keeps_its_own() -> None:
    rows = np.zeros(1, [("bound", "f8")])
    rows["bound"] = 7.0
    spec = Spec(("friction",), (), "jacobi", operator="matrix")
    interpreted(make_bound(spec))(records(rows), 1, np.zeros(0, np.int64))
    assert rows["bound"][0] == 7.0
