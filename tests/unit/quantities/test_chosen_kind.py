"""Values of one of several kinds: all made ready or only what is named, to the same outcome."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Union

import pytest
from pydantic import Field, TypeAdapter, ValidationError

from lavendersim.quantities.chosen_kind import NO_KIND, ByKind, kinds, one_of
from lavendersim.quantities.model import ConfigModel


class Ball(ConfigModel):
    """A kind with a key of its own."""

    kind: Literal["ball"]
    radius: float = Field(gt=0.0)


class Box(ConfigModel):
    """A kind whose key holds several values."""

    kind: Literal["box"]
    sides: tuple[float, ...] = ()


KINDS: dict[str, type[ConfigModel]] = {"ball": Ball, "box": Box}
OF_ALL: Any = Annotated[Union[Ball, Box], ByKind()]  # noqa: UP007
BY_PYDANTIC: Any = Annotated[Union[Ball, Box], Field(discriminator="kind")]  # noqa: UP007
CHOSEN: Any = one_of(KINDS)

RIGHT = [
    {"kind": "ball", "radius": 2.0},
    {"kind": "box", "sides": (1.0, 2.0)},
    {"kind": "box"},
    Ball(kind="ball", radius=1.0),
]
WRONG = [
    {"kind": "ball"},
    {"kind": "ball", "radius": -1.0},
    {"kind": "ball", "radius": 1.0, "sides": ()},
    {"kind": "box", "sides": (1.0, "2")},
    {"kind": "balls", "radius": 1.0},
    {"kind": 3},
    {"kind": ["ball"]},
    {"radius": 1.0},
    {},
    None,
    "ball",
    ("kind", "ball"),
]


def outcome(kind: Any, value: Any) -> Any:
    """Return what a value in a mapping is read to, or all errors with their places."""
    try:
        return TypeAdapter(dict[str, kind]).validate_python({"here": value})
    except ValidationError as error:
        return error.errors(include_url=False)


@pytest.mark.parametrize("value", RIGHT, ids=repr)
def test_right_values_are_read_to_the_same_model(value: Any) -> None:
    read = outcome(CHOSEN, value)
    assert read == outcome(OF_ALL, value)
    assert isinstance(read, dict)


@pytest.mark.parametrize("value", WRONG, ids=repr)
def test_errors_have_the_place_and_the_type_that_pydantic_gives(value: Any) -> None:
    errors = outcome(CHOSEN, value)
    assert errors == outcome(OF_ALL, value)
    assert isinstance(errors, list)
    assert errors[0]["loc"][0] == "here"


@pytest.mark.parametrize("value", WRONG, ids=repr)
def test_errors_stand_where_those_of_pydantic_s_own_union_do(value: Any) -> None:
    """Of what is no known kind there is one type of error, which lists the kinds."""
    own, errors = outcome(BY_PYDANTIC, value), outcome(OF_ALL, value)
    assert [one["loc"] for one in errors] == [one["loc"] for one in own]
    for one, other in zip(errors, own, strict=True):
        if one["type"] == NO_KIND:
            assert one["ctx"] == {"kinds": "ball, box"}
            assert other["type"].startswith(("union_tag", "model_attributes"))
        else:
            assert one["type"] == other["type"]


def test_kinds_are_the_values_that_choose_a_model() -> None:
    class Several(ConfigModel):
        kind: Literal["one", "first"]

    assert kinds(Several) == ("one", "first")
    assert kinds(ConfigModel) == ()


def test_the_context_reaches_the_model() -> None:
    entered = []

    class Reading:
        def enter(self, model: Any, data: Any) -> None:
            entered.append((model, data["kind"]))

    TypeAdapter(CHOSEN).validate_python({"kind": "box"}, context=Reading())
    assert entered == [(Box, "box")]


def test_only_the_kind_that_is_named_is_made_ready() -> None:
    class One(ConfigModel):
        kind: Literal["one"]

    class Other(ConfigModel):
        kind: Literal["other"]

    chosen: Any = one_of({"one": One, "other": Other})
    assert TypeAdapter(chosen).validate_python({"kind": "one"}) == One(kind="one")
    assert One.__pydantic_complete__
    assert not Other.__pydantic_complete__


def test_the_json_schema_has_all_kinds() -> None:
    class WithChosen(ConfigModel):
        value: CHOSEN

    class WithAll(ConfigModel):
        value: OF_ALL

    chosen, whole = WithChosen.model_json_schema(), WithAll.model_json_schema()
    assert chosen["$defs"] == whole["$defs"]
    assert chosen["properties"] == whole["properties"]
