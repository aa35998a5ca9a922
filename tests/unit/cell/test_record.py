"""Of which steps something is logged: `none`, `all`, `every N`, or a stretch of time."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import TypeAdapter, ValidationError

from lavendersim.cell.record import (
    CellRecord,
    EveryOrAll,
    EveryOrNone,
    TimeWindow,
    in_words,
    steps_between,
)


def refused(annotation: Any, value: object) -> str:
    """Return the sentence with which a value is refused."""
    with pytest.raises(ValidationError) as error:
        TypeAdapter(annotation).validate_python(value)
    return str(error.value.errors()[0]["ctx"]["sentence"])


@pytest.mark.parametrize(("text", "between"), [("every 1", 1), ("every 250", 250), ("all", 0)])
def test_texts_that_are_taken(text: str, between: int) -> None:
    assert TypeAdapter(EveryOrAll).validate_python(text) == text
    assert steps_between(text) == between


@pytest.mark.parametrize("value", ["every 0", "every -3", "every", "every 1.5", 0, True, "none"])
def test_what_is_no_number_of_steps_is_refused(value: object) -> None:
    assert "every N with a whole number of steps N of 1 or more" in refused(EveryOrAll, value)


def test_a_number_alone_is_reported_as_the_text() -> None:
    assert refused(EveryOrNone, 4).endswith('; did you mean "every 4"?')
    assert refused(EveryOrNone, "all").endswith('; did you mean "every 1"?')


def test_in_words_it_is_as_a_config_would_have_it() -> None:
    window = TimeWindow.model_validate({"from": 0.5, "to": 2.0})
    assert in_words(window) == "from 0.5 to 2 s"
    assert in_words("every 4") == "every 4"


def test_a_record_of_an_older_log_has_contacts_and_poses_of_all_steps() -> None:
    record = CellRecord(residuals="none", problems="none")
    assert (record.contacts, record.poses) == ("all", "all")
