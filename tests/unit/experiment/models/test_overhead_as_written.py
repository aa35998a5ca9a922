"""The section `overhead` as written: one cell whose steps are timed in one go."""

from __future__ import annotations

import pytest
from pydantic import TypeAdapter, ValidationError

from lavendersim.experiment.models.overhead import EffectNames
from tests.marked_config import assert_refused, config, refusals, scene

FOUND = "overhead: expected one cell without events and constant forces, found"


def marked(**sections: str) -> str:
    return config(**sections).replace("scene:", "§overhead: {}\nscene:", 1)


@pytest.mark.parametrize(
    ("sections", "found"),
    [
        ({"sweep": "{m: {path: scene.bodies.ball.mass, values: [1]}}"}, "sweep"),
        ({"events": "[{at: 0.5, body: ball, velocity: [0, 0, 1]}]"}, "events"),
        ({"scene": scene(forces="[{body: ball, force: [1, 0, 0]}]")}, "scene.forces"),
    ],
)
def test_what_interrupts_the_steps_is_refused_at_the_section(
    sections: dict[str, str], found: str
) -> None:
    assert_refused(marked(**sections), f"{FOUND} {found}")


@pytest.mark.parametrize(
    "force",
    [
        "factor: {kind: sine, frequency: 1}, force: [1, 0, 0]",
        "frame: body, force: [1, 0, 0]",
        "point: [0, 0, 0.1], force: [1, 0, 0]",
    ],
)
def test_a_force_that_acts_within_the_steps_does_not_interrupt(force: str) -> None:
    text = config(scene=scene(forces=f"[{{body: ball, {force}}}]"), overhead="{}")
    assert refusals(text) == []
    central = text.replace("point: [0, 0, 0.1]", "point: [0, 0, 0]")
    assert bool(refusals(central)) == ("point" in force)


def test_what_is_timed_begins_before_the_end() -> None:
    assert refusals(config(overhead="{from: 0.999}")) == []
    assert_refused(
        config(overhead="{from: §1}"),
        "from: expected a time before the end (duration 1 s), found 1",
    )


def test_all_or_a_list_of_names() -> None:
    names: TypeAdapter[object] = TypeAdapter(EffectNames)
    for value in ("all", "required", ("drag",)):
        assert names.validate_python(value) == value
    for value in ("some", None, 3, ()):
        with pytest.raises(ValidationError):
            names.validate_python(value)
    assert_refused(
        config(overhead="{effects: §drag}"),
        'effects: expected all, required, or a list of effects, found the text "drag"',
    )
