"""The bytes of a log before it is written: what grows with steps, bodies and contacts."""

from __future__ import annotations

import pytest

from lavendersim.trace.expected_size import (
    BYTES_PER_BODY,
    FRAMEWORK,
    StepContent,
    expected_size,
)

TOPICS = {"/robot_description", "/step", "/tf", "/contacts", "/contact_columns"}
COLUMNS = tuple((name, "f8") for name in ("x", "y", "z", "force_n"))


def size(steps: int = 100, bodies: int = 2, text: str = "", topics: set[str] = TOPICS, **of):
    """Return the size of a log of steps with some content."""
    content = {"step_columns": 20, "contact_columns": COLUMNS, "moving": 1.0, "contacts": 2.0}
    return expected_size(StepContent(**content | of), topics, steps, bodies, text)


def test_it_is_a_constant_and_a_part_for_each_state() -> None:
    fixed = FRAMEWORK + 2 * BYTES_PER_BODY
    # States are the steps and the initial one.
    one = (size(steps=100) - fixed) / 101
    assert (size(steps=999) - fixed) / 1000 == pytest.approx(one, rel=1e-12)
    assert one > 0.0


def test_the_text_is_written_as_it_is_in_its_bytes() -> None:
    assert size(text="é" * 50) - size() == 100


def test_topics_that_a_log_does_without_take_nothing() -> None:
    without = TOPICS - {"/contacts", "/contact_columns"}
    assert size(topics=without) == size(topics=without, contacts=1e6)
    assert size(topics=without) < size()
    assert size(contacts=4.0) - size() == pytest.approx(size() - size(contacts=0.0), rel=1e-12)


def test_a_sweep_has_a_number_more() -> None:
    one, two = size(sweeps=10.0), size(sweeps=20.0)
    assert two - one == pytest.approx(101 * 8 * 10.0)
