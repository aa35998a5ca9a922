"""Whether a decision read how bodies start is noted, at whatever depth it did."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from lavendersim.scene.facts import facts_of
from lavendersim.scene.starts_read import StartsRead
from tests.made_cells import made_cell

FACTS = facts_of(made_cell({"ball": {"shape": {"kind": "sphere", "radius": 0.1}}}))


@pytest.mark.parametrize(
    ("read", "noted"),
    [
        (lambda facts: facts.gravity, False),
        (lambda facts: facts.bodies[0].size, False),
        (lambda facts: facts.bodies[0].config.drag, False),
        (lambda facts: facts.bodies[0].speed, True),
        (lambda facts: facts.bodies[0].config.velocity, True),
        (lambda facts: facts.scene.bodies, True),
    ],
)
def test_what_was_read(read: Callable[[Any], Any], noted: bool) -> None:
    starts = StartsRead()
    assert starts.any is None
    watched = starts.watched(FACTS)
    assert starts.any is False
    assert read(watched) == read(FACTS)
    assert starts.any is noted
