"""What is removed is fixed, untouchable and in no pair; every other row stays as it was."""

from __future__ import annotations

import numpy as np

from lavendersim.engine import removal
from lavendersim.engine.records import ANGULAR_VELOCITY, BODY, LINK, NO_PAIR, PAIR, VELOCITY, dtype

OWN = [
    *[(name, "f8") for name in ("inv_ix", "inv_iy", "inv_iz", "fx", "ty")],
    *[(name, "i8") for name in ("kinematic", "asleep", "material", "joined")],
]


def bodies(*more) -> np.ndarray:
    made = np.zeros(5, dtype(BODY, OWN, more))
    for name in made.dtype.names:
        made[name] = np.arange(1, 6)
    return made


def test_a_body_is_its_own_row_or_all_rows_that_it_owns() -> None:
    assert removal.rows_of(bodies(), 3).tolist() == [False, False, False, True, False]
    compound = bodies(("owner", "i8"))
    compound["owner"] = [0, 1, 1, 0, 4]
    assert removal.rows_of(compound, 1).tolist() == [False, True, True, False, False]


def test_rows_held_still_have_no_mass_no_force_and_no_velocity() -> None:
    made, before = bodies(), bodies()
    velocities = np.ones(5, dtype(VELOCITY, ANGULAR_VELOCITY))
    rows = np.array([False, True, False, True, False])
    removal.hold_still(made, velocities, rows)
    for name in ("inv_m", "inv_ix", "inv_iy", "inv_iz", "kinematic", "asleep", "fx", "ty"):
        assert not made[name][rows].any(), name
    for name in ("x", "y", "z", "shape", "bound", "material"):
        np.testing.assert_array_equal(made[name], before[name])
    np.testing.assert_array_equal(made[~rows], before[~rows])
    for name in velocities.dtype.names:
        assert velocities[name].tolist() == [1.0, 0.0, 1.0, 0.0, 1.0]


def test_links_of_a_body_are_cut_and_only_who_is_still_joined_stays_so() -> None:
    links = np.zeros(4, dtype(LINK))
    links["a"], links["b"], links["active"] = [0, 1, 2, 3], [1, 2, 3, 4], [1, 1, 1, 0]
    made = bodies()
    removal.cut_links(links, made, 1)
    assert links["active"].tolist() == [0, 0, 1, 0]
    assert made["joined"].tolist() == [0, 0, 1, 1, 0]


def test_pairs_of_its_rows_are_left_out_in_order() -> None:
    pairs = np.zeros(4, dtype(PAIR))
    pairs["a"], pairs["b"], pairs["key"] = [0, 1, 2, 0], [1, 3, 3, 4], [7, 8, 9, 10]
    rows = np.array([False, True, False, False, False])
    left = removal.pairs_without(pairs, rows)
    assert left["key"].tolist() == [9, 10]
    assert left.flags.c_contiguous


def test_its_class_touches_no_other_and_all_others_as_before() -> None:
    templates = np.zeros((2, 2), [("kind", "i8"), ("friction", "f8")])
    templates["kind"], templates["friction"] = [[0, 1], [2, 3]], 0.5
    made = bodies()
    rows = np.array([False, False, True, False, False])
    grown = removal.make_untouchable(made, templates, rows)
    assert grown.shape == (3, 3)
    np.testing.assert_array_equal(grown[:2, :2], templates)
    assert set(grown["kind"][2]) == set(grown["kind"][:, 2]) == {NO_PAIR}
    assert made["material"].tolist() == [1, 2, 2, 4, 5]
