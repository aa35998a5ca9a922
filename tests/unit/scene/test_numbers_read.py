"""Whether a decision read how bodies start, or how heavy they are, is noted, at any depth."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from lavendersim.scene.facts import facts_of
from lavendersim.scene.numbers_read import NumbersRead
from tests.made_cells import made_cell

FACTS = facts_of(made_cell({"ball": {"shape": {"kind": "sphere", "radius": 0.1}}}))


NOTHING, STARTS, MASSES = (False, False), (True, False), (False, True)
BRICK = FACTS.bodies[0].config.model_copy(update={"inertia": (1.0, 2.0, 2.0)})
NEARLY = BRICK.model_copy(update={"inertia": (1.0, 1.0, 1.0 + 1e-15)})


@pytest.mark.parametrize(
    ("read", "noted"),
    [
        (lambda facts: facts.gravity, NOTHING),
        (lambda facts: facts.bodies[0].size, NOTHING),
        (lambda facts: facts.bodies[0].round, NOTHING),
        (lambda facts: facts.bodies[0].config.drag, NOTHING),
        (lambda facts: facts.bodies[0].forms[0].drag, NOTHING),
        (lambda facts: facts.bodies[0].speed, STARTS),
        (lambda facts: facts.bodies[0].config.velocity, STARTS),
        (lambda facts: facts.bodies[0].config.mass, MASSES),
        (lambda facts: facts.bodies[0].forms[0].velocity, STARTS),
        (lambda facts: facts.bodies[0].forms[0].inertia, MASSES),
        (lambda facts: facts.scene.bodies, (True, True)),
    ],
)
def test_what_was_read(read: Callable[[Any], Any], noted: tuple[bool, bool]) -> None:
    numbers = NumbersRead()
    assert not numbers.none
    watched = numbers.watched(FACTS)
    assert numbers.none
    assert read(watched) == read(FACTS)
    assert (numbers.starts, numbers.masses) == noted


# Of the first mass its moments are equal, of 1.1 kg one is larger by a last digit.
SIDE = 0.12061855670103093
CUBE = made_cell(
    {"box": {"shape": {"kind": "box", "size": [SIDE, SIDE, SIDE]}, "mass": 1.7}}
).scene.bodies["box"]
ROUNDED = made_cell(
    {"box": {"shape": {"kind": "box", "size": [SIDE, SIDE, math.nextafter(SIDE, 1)]}, "mass": 1.7}}
).scene.bodies["box"]


@pytest.mark.parametrize(
    ("config", "noted"),
    [(BRICK, NOTHING), (NEARLY, MASSES), (CUBE, NOTHING), (ROUNDED, MASSES)],
)
def test_moments_that_a_mass_may_round_to_equal_ones_depend_on_it(
    config: Any, noted: tuple[bool, bool]
) -> None:
    body = FACTS.bodies[0]._replace(config=config, round=False)
    numbers = NumbersRead()
    assert not numbers.watched(FACTS._replace(bodies=(body,))).bodies[0].round
    assert (numbers.starts, numbers.masses) == noted
