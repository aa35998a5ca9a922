"""What annotations say: members of unions, keys under aliases, the model of a kind."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, Field

from lavendersim.experiment.checks.annotations import (
    alternatives,
    fields,
    inside,
    is_vector,
    kinds,
    literals,
    model_for,
    models_of,
    names_of,
)
from lavendersim.experiment.text.node import Mark, Node

AT = Mark(1, 1)


class One(BaseModel):
    kind: Literal["one", "first"]
    begin: float = Field(alias="from")


class Other(BaseModel):
    kind: Literal["other"]


Either = Annotated[Annotated[One, "tag"] | Other, "discriminator"]


def node(kind: str) -> Node:
    """Return a mapping with a kind."""
    return Node({"kind": Node(kind, AT)}, AT)


def test_a_union_is_its_members_without_what_is_annotated() -> None:
    assert alternatives(Either | None) == [One, Other, type(None)]
    assert alternatives(float) == [float]
    assert models_of(Either | float) == [One, Other]


def test_a_mapping_follows_the_model_of_its_kind_or_the_only_one() -> None:
    assert model_for(Either, node("first")) is One
    assert model_for(Either, node("other")) is Other
    assert model_for(Either, node("none")) is None
    assert model_for(One | float, node("none")) is One
    assert model_for(float, node("one")) is None


def test_keys_are_those_of_the_file() -> None:
    assert list(fields(One)) == ["kind", "from"]
    assert kinds(One) == ("one", "first")
    assert literals(float) == ()


def test_what_a_dict_and_a_list_hold() -> None:
    assert inside(dict[str, One] | None, dict) is One
    assert inside(tuple[float, ...], tuple) is float
    assert inside(float, dict) is None
    assert is_vector(tuple[float, float])
    assert not is_vector(tuple[float, ...])


def test_keys_that_are_names_have_one_type() -> None:
    class Named(BaseModel, extra="allow"):
        __pydantic_extra__: dict[str, float]

    Named.__annotations__["__pydantic_extra__"] = dict[str, float]
    assert names_of(Named) is float
    assert names_of(One) is None
