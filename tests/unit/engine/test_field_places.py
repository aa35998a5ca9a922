"""Parts name the places of fields; each whole kernel gives those of its plan (`field_places`)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numba import float64, from_dtype

from lavendersim.engine.compile import inner, separate
from lavendersim.engine.field_places import composed_in, composed_name, digest
from lavendersim.engine.records import (
    ANGULAR_VELOCITY,
    BODY,
    CONTACT,
    LINK,
    MOTION,
    PAIR,
    VELOCITY,
    dtype,
)
from lavendersim.engine.solvers.packed.layout import START
from lavendersim.engine.spec import Spec

BOXES = Spec(shape_pairs=frozenset({"box_plane"}))
MU, TAU = [("mu", "f8")], [("tau_x", "f8"), ("tau_y", "f8")]
LAYOUTS = dtype(CONTACT, MU), dtype(CONTACT, TAU, MU)


def contacts(layout: np.dtype) -> np.ndarray:
    """Return three contacts whose fields all have values of their own."""
    rows = np.zeros(3, layout)
    for column, name in enumerate(layout.names or ()):
        rows[name] = [100 * column + row for row in range(3)]
    return rows


def change(rows: Any, at: int) -> float:
    """Read, write and copy rows in every way that kernels do."""
    row = rows[at]
    row.mu += row.lambda_n
    row.feature = 7
    row["key"] = row["pair"]
    rows[0].phi = rows[2].mu
    rows[1] = rows[at]
    rows[0] = rows[-1]
    return rows[1].mu + rows[-2].phi


def by_numpy(rows: np.ndarray, at: int) -> float:
    """Do what `change` does."""
    rows["mu"][at] += rows["lambda_n"][at]
    rows["feature"][at] = 7
    rows["key"][at] = rows["pair"][at]
    rows["phi"][0] = rows["mu"][2]
    rows[1], rows[0] = rows[at], rows[-1]
    return float(rows["mu"][1] + rows["phi"][-2])


def called_by_a_kernel(part: Any) -> Any:
    def caller(rows, at):
        return part(rows, at)

    return inner(caller)


@pytest.mark.parametrize("apart", [False, True], ids=["merged", "separate"])
def test_one_part_serves_records_of_all_plans(apart: bool) -> None:
    part = separate(inner(change), BOXES) if apart else inner(change)
    caller = called_by_a_kernel(part)
    for layout in LAYOUTS:
        rows, expected = contacts(layout), contacts(layout)
        assert caller(rows, 2) == by_numpy(expected, 2)
        assert rows.tobytes() == expected.tobytes()
    first, second = (linked.part for linked in part.linked.values())
    assert first is second
    assert {place.split(".")[2] for place in first.places} == {"contact"}


def test_only_records_that_plans_compose_have_named_places() -> None:
    def name(*fields: Any) -> str:
        return composed_name(from_dtype(dtype(*fields)))

    assert [name(each, MU) for each in (BODY, VELOCITY, PAIR, CONTACT, LINK)] == [
        "body",
        "velocity",
        "pair",
        "contact",
        "link",
    ]
    assert name([("key", "i8"), ("px", "f8")]) == "cache"
    assert name(START) == name(MOTION) == name(MU) == composed_name(float64) == ""
    assert name(VELOCITY, ANGULAR_VELOCITY, MU) == "velocity"


def test_rows_of_the_log_keep_their_places() -> None:
    packed = np.dtype([(name, kind) for name, kind in CONTACT], align=False)
    assert composed_name(from_dtype(np.dtype([*packed.descr, ("time", "u4")]))) == ""


def test_two_layouts_of_one_record_in_a_kernel_are_refused() -> None:
    first, second = (from_dtype(layout)[::1] for layout in LAYOUTS)
    assert list(composed_in([first, first, float64])) == ["contact"]
    with pytest.raises(RuntimeError, match="two records of a contact"):
        composed_in([first, second])


def test_what_numba_would_compile_for_one_plan_is_refused() -> None:
    def first_two(rows, at):
        return rows[:2].shape[0] + at

    with pytest.raises(NotImplementedError, match=r"first_two.*of a record that plans compose"):
        called_by_a_kernel(inner(first_two))(contacts(LAYOUTS[0]), 1)


def test_objects_of_separate_parts_differ_by_the_places_they_touch() -> None:
    first, second = ({"contact": from_dtype(layout)} for layout in LAYOUTS)
    moved, same = ".place.contact.mu", ".place.contact.phi"
    assert digest([same], first) == digest([same], second)
    assert digest([moved], first) != digest([moved], second)
    assert digest([".place.contact.row"], first) != digest([".place.contact.row"], second)
