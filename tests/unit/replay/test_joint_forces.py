"""A joint's rows of a step are one force; contacts, and logs without joints, stay as they are."""

from __future__ import annotations

import numpy as np
from synthetic_trace import CONTACT_FIELDS

from lavendersim.replay.force_scale import force_scale
from lavendersim.replay.joint_forces import has_joints, with_whole_forces

FIELDS = [*np.dtype(CONTACT_FIELDS).descr, ("joint", "<i8")]


def rows() -> np.ndarray:
    """A contact between two joints in step 1; the second joint alone in step 2, without a force."""
    table = np.zeros(8, FIELDS)
    table["step"] = [1, 1, 1, 1, 1, 2, 2, 2]
    table["joint"] = [1, 1, 0, 2, 2, 2, 2, 2]
    table["force_n"] = [3.0, -4.0, 7.0, 1.0, 1.0, 0.0, 0.0, 0.0]
    for k, axis in enumerate("xzzyyxyz"):
        table[f"n{axis}"][k] = 1.0
    table["x"] = np.arange(8)
    return table


def test_a_joint_has_the_sum_of_its_rows_where_the_first_is() -> None:
    found = with_whole_forces(rows())
    assert found["step"].tolist() == [1, 1, 1, 2]
    assert found["joint"].tolist() == [1, 0, 2, 2]
    assert found["force_n"].tolist() == [5.0, 7.0, 2.0, 0.0]
    assert found["x"].tolist() == [0.0, 2.0, 3.0, 5.0]
    normals = np.column_stack([found[f"n{axis}"] for axis in "xyz"])
    np.testing.assert_allclose(normals[0], [0.6, 0.0, -0.8], rtol=1e-15)
    np.testing.assert_array_equal(normals[1:], [[0, 0, 1], [0, 1, 0], [1, 0, 0]])


def test_a_log_without_joints_is_as_it_is_and_none_of_joints_is_changed() -> None:
    table = rows()
    before = table.copy()
    with_whole_forces(table)
    np.testing.assert_array_equal(table, before)
    table["joint"] = 0
    assert with_whole_forces(table) is table
    assert not has_joints(table[list(np.dtype(CONTACT_FIELDS).names)])


def test_the_title_says_whose_forces_they_are() -> None:
    assert force_scale(rows(), 1.0).label.startswith("forces of contacts and joints: 1 m = ")
    assert force_scale(rows()[2:3], 1.0).label.startswith("contact forces: 1 m = ")
    assert force_scale(rows()[:2], 1.0).label.startswith("forces of joints: 1 m = ")
