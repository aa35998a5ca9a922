"""Every column the engine records is described in the log's schema, with its kind and its unit."""

from __future__ import annotations

import re

import pytest

from lavendersim.engine.effects import EFFECTS, Column
from lavendersim.trace.schema import CONTACT_COLUMNS, RESIDUAL_COLUMNS, STEP_COLUMNS

UNIT = re.compile(r"\[[^]]+\]")
# Counts, indices, hashes and directions have no unit.
WITHOUT_UNIT = {
    "parts", "unordered", "substeps", "rejected", "estimated_error",
    "step", "contact_count", "sweeps", "residual_contact", "state_hash", "sweep", "triggered",
    "awake", "stronge", "not_converged",
    "gjk_not_converged", "epa_not_converged", "stronge_not_converged", "ascent_not_converged",
    "advance_not_converged", "impact_not_converged", "midpoint_not_converged",
    "gyroscopic_not_converged", "spring_not_converged", "least_norm_not_converged",
    "signorini_contact", "cone_contact", "dissipation_contact",
    "body_a", "body_b", "feature", "joint", "rope", "nx", "ny", "nz", "t1x", "t1y", "t1z",
}  # fmt: skip
# The step of a contact or a residual is the number of the message that carries it.
OF_THE_MESSAGE = "step"


CONTACTS = [column for effect in EFFECTS for column in effect.contact_columns]
STEPS = [column for effect in EFFECTS for column in effect.step_columns]
RESIDUALS = [column for effect in EFFECTS for column in effect.residual_columns][1:]
STEP = {column.name: column for column in STEP_COLUMNS}
RESIDUAL = {column.name: column for column in RESIDUAL_COLUMNS}


def names(columns: list[Column]) -> list[str]:
    """Return the names of recorded columns."""
    return [column.name for column in columns]


@pytest.mark.parametrize("column", STEPS, ids=names(STEPS))
def test_a_step_column_is_described_with_its_kind_and_unit(column: Column) -> None:
    known = STEP[column.name]
    assert (known.kind, known.number, known.meaning) == (column.kind, column.number, column.text)
    assert bool(UNIT.search(known.meaning)) != (column.name in WITHOUT_UNIT)


@pytest.mark.parametrize("column", CONTACTS, ids=names(CONTACTS))
def test_a_contact_column_is_described_with_its_unit(column: Column) -> None:
    assert bool(column.unit) != (column.name in WITHOUT_UNIT)
    if column.name != OF_THE_MESSAGE:
        assert CONTACT_COLUMNS[column.name] == column.text


@pytest.mark.parametrize("column", RESIDUALS, ids=names(RESIDUALS))
def test_a_residual_column_is_described_with_its_kind_and_unit(column: Column) -> None:
    known = RESIDUAL[column.name]
    assert (known.kind, known.number, known.meaning) == (column.kind, column.number, column.text)
    assert bool(UNIT.search(known.meaning)) != (column.name in WITHOUT_UNIT)


def test_numbers_of_step_columns_are_never_used_twice() -> None:
    for columns in (STEP_COLUMNS, RESIDUAL_COLUMNS):
        numbers = [column.number for column in columns]
        assert len(set(numbers)) == len(numbers)
