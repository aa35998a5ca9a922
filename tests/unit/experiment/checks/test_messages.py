"""From pydantic's errors to sentences: what was found, what is expected, the nearest name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

import pytest
from pydantic import Field, ValidationError

from lavendersim.experiment.checks.messages import fields, locate, report_errors
from lavendersim.experiment.text.node import Node
from lavendersim.experiment.text.parse import parse
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.chosen_kind import ByKind
from lavendersim.quantities.model import ConfigModel
from tests.marked_config import assert_refused, config, marked_places


class Round(ConfigModel):
    kind: Literal["round"]
    radius: Annotated[float, Field(description="[m] of it")]


class Square(ConfigModel):
    kind: Literal["square"]


class Things(ConfigModel):
    MISPLACED: ClassVar[Mapping[str, str]] = {"size": "write shape: {kind: square}"}

    name: str = Field(default="", min_length=1)
    on: bool = False
    colour: Literal["red", "green"] = "red"
    few: tuple[int, ...] = Field(default=(), min_length=1, max_length=3)
    shape: Annotated[Round | Square, ByKind()] | None = None
    inner: Square | None = None


def plain(node: Node) -> Any:
    if node.entries or node.content == {}:
        return {key: plain(child) for key, child in node.entries.items()}
    return tuple(map(plain, node.items)) if isinstance(node.content, tuple) else node.content


def said(marked: str) -> tuple[list[str], list[str]]:
    """Return the sentences with their places, and the places of the marks."""
    text, places = marked_places(marked)
    report = Report("f")
    root = parse(text.encode(), report)
    assert root is not None
    shape = root.get("shape", "kind").text
    models: dict[Any, Any] = {(): Things, ("inner",): Square}
    models[("shape",)] = {"round": Round, "square": Square}.get(shape or "", Things)
    try:
        Things.model_validate(plain(root))
    except ValidationError as error:
        report_errors(error, root, models, report)
    return [str(defect).removeprefix("f:") for defect in report.defects], places


@pytest.mark.parametrize(
    ("marked", "sentence"),
    [
        ("§nam: x", 'unknown key "nam" in the experiment; did you mean "name"?'),
        ("§size: 1", 'unknown key "size" in the experiment; write shape: {kind: square}'),
        ("name: §3", "name: expected text, found 3; put it in quotes"),
        ("name: §''", "name: expected text, found an empty one"),
        ("on: §yes", 'on: expected true or false, found the text "yes"; write true'),
        ("on: §Off", 'on: expected true or false, found the text "Off"; write false'),
        (
            "colour: §rad",
            'colour: expected red or green, found the text "rad"; did you mean "red"?',
        ),
        ("few: §[]", "few: expected 1 item or more, found none"),
        ("few: §[1, 2, 3, 4]", "few: expected 3 items or fewer, found 4"),
        ("shape: §{radius: 1}", 'missing key "kind" in shape: one of round, square'),
        ("shape: {kind: §3}", "kind: expected one of round, square, found 3"),
        ("shape: {kind: §rount}", 'unknown kind "rount" in shape; did you mean "round"?'),
        ("shape: §{kind: round}", 'missing key "radius" in shape: [m] of it'),
        ("inner: §3", "inner: expected a mapping, found 3; write {kind: ...}"),
        (
            "shape: §rount",
            'shape: expected a mapping, found the text "rount"; write {kind: round, ...}',
        ),
    ],
)
def test_every_kind_of_error_is_a_sentence_at_its_place(marked: str, sentence: str) -> None:
    found, places = said(marked)
    assert found == [f"{place}: {sentence}" for place in places]


def test_a_misspelt_required_key_is_not_missing_as_well() -> None:
    found, (place,) = said("shape: {kind: round, §radiuss: 1}")
    assert found == [f'{place}: unknown key "radiuss" in shape; did you mean "radius"?']
    found, places = said("shape: §{kind: round, §weight: 1}")
    assert [line.rsplit(":", 1)[0].split(": ")[0] for line in found] == places  # both


def test_a_location_ends_where_the_file_does() -> None:
    """Pydantic's locations have tags of unions between the keys of the file."""
    root = parse(b"a: {b: [1, 2]}", Report(""))
    assert root is not None
    path, node = locate(root, ("a", "tag", "b", 1, "int"))
    assert path == ("a", "b", 1)
    assert node.number == 2


def test_fields_stand_under_their_aliases() -> None:
    class Span(ConfigModel):
        begin: float = Field(alias="from")
        end: float = 0.0

    assert list(fields(Span)) == ["from", "end"]


def test_a_mapping_that_is_wrong_inside_was_not_meant_as_a_number() -> None:
    """`equals` is a number, a formula, or a mapping: of a mapping its own defects count."""
    swept = {"measure": "{a: {kind: apex_error, body: ball, above: floor}}"}
    claim = "[{name: it, measure: a, equals: {value: 1, §tolerance: 1}}]"
    unknown = 'unknown key "tolerance" in expect[0].equals; '
    assert_refused(
        config(**swept, expect=claim),
        unknown + "valid here: value, closed_form, relative, absolute",
    )


def test_a_list_in_place_of_a_mapping_gets_the_keys_of_the_mapping() -> None:
    sweep = "{dt: {path: numerics.timestep, range: §[0.01, 0.02, 2]}}"
    assert_refused(
        config(sweep=sweep),
        "range: expected a mapping, found a list of 3; write {from: ..., to: ..., steps: ...}",
    )


@pytest.mark.parametrize(
    ("body", "hint"),
    [
        (
            "§plane",
            'floor: expected a mapping, found the text "plane"; write {shape: {kind: ...}, ...}',
        ),
        (
            "{shape: §plane}",
            'shape: expected a mapping, found the text "plane"; write {kind: plane, ...}',
        ),
        (
            "{shape: {kind: plane}, §radius: 1}",
            'unknown key "radius" in scene.bodies.floor; write shape: {kind: ..., radius: ...}',
        ),
        (
            "{shape: {kind: plane, normal: §-z}}",
            'normal: expected a list of 3 numbers, found the text "-z"; write [0, 0, -1]',
        ),
        (
            "{shape: {kind: plane}, fixed: true, surface: §ice}",
            'surface: no surface is called "ice"; this file has none: '
            "write surfaces: {ice: {friction: ...}} into scene",
        ),
    ],
)
def test_what_a_body_was_to_be_is_written_out(body: str, hint: str) -> None:
    ball = "{shape: {kind: sphere, radius: 1}, mass: 1, position: [0, 0, 1]}"
    assert_refused(f"scene: {{bodies: {{ball: {ball}, floor: {body}}}}}\nduration: 1\n", hint)


def test_an_axis_that_is_a_list_of_values_lacks_its_path() -> None:
    assert_refused(
        config(sweep="{mass: §[1, 2]}"),
        "mass: expected a mapping, found a list of 2; write {path: ..., values: [...]}",
    )
