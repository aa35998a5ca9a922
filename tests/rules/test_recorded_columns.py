"""Every column the engine records is described in the log's schema, with its kind and its unit."""

from __future__ import annotations

import re

import pytest

from lavendersim.engine.effects import EFFECTS, residual_log, step_log
from lavendersim.engine.records import Field
from lavendersim.trace.schema import CONTACT_COLUMNS, RESIDUAL_COLUMNS, STEP_COLUMNS

UNIT = re.compile(r"\[[^]]+\]")
# Counts, indices, hashes and directions have no unit.
WITHOUT_UNIT = {
    "step", "contact_count", "sweeps", "residual_contact", "state_hash", "sweep",
    "awake", "stronge", "unsolved",
    "signorini_contact", "cone_contact", "dissipation_contact",
    "body_a", "body_b", "feature", "nx", "ny", "nz", "t1x", "t1y", "t1z",
}  # fmt: skip
# The step of a contact or a residual is the number of the message that carries it.
OF_THE_MESSAGE = "step"


def rows(group: str) -> list[Field]:
    """Return the columns that all effects log."""
    return [field for effect in EFFECTS for field in getattr(effect, group, [])]


CONTACTS = rows("CONTACT_ROW_FIELDS")
STEPS = [*rows("STEP_ROW_FIELDS"), *step_log.UNSOLVED_ROW]
RESIDUALS = residual_log.RESIDUAL_ROW_FIELDS[1:]
STEP = {column.name: column for column in STEP_COLUMNS}
RESIDUAL = {column.name: column for column in RESIDUAL_COLUMNS}


def names(rows: list[Field]) -> list[str]:
    """Return the names of recorded fields."""
    return [name for name, _ in rows]


@pytest.mark.parametrize("field", STEPS, ids=names(STEPS))
def test_a_step_column_is_described_with_its_kind_and_unit(field: Field) -> None:
    name, kind = field
    assert STEP[name].kind == kind
    assert bool(UNIT.search(STEP[name].meaning)) != (name in WITHOUT_UNIT)


@pytest.mark.parametrize("name", [name for name in names(CONTACTS) if name != OF_THE_MESSAGE])
def test_a_contact_column_is_described_with_its_unit(name: str) -> None:
    assert bool(UNIT.search(CONTACT_COLUMNS[name])) != (name in WITHOUT_UNIT)


@pytest.mark.parametrize("field", RESIDUALS, ids=names(RESIDUALS))
def test_a_residual_column_is_described_with_its_kind_and_unit(field: Field) -> None:
    name, kind = field
    assert RESIDUAL[name].kind == kind
    assert bool(UNIT.search(RESIDUAL[name].meaning)) != (name in WITHOUT_UNIT)


def test_numbers_of_step_columns_are_never_used_twice() -> None:
    for columns in (STEP_COLUMNS, RESIDUAL_COLUMNS):
        numbers = [column.number for column in columns]
        assert len(set(numbers)) == len(numbers)
