"""Models of a config refuse what they do not know; declared keys become fields behind a base's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pytest
from pydantic import ValidationError

from lavendersim.quantities.model import ConfigModel, ResolvedModel, declared


class Base(ConfigModel):
    own: float


@dataclass
class Key:
    name: str
    type: Any = float
    default: Any = 0.0
    doc: str = "[m] a length"


def test_no_silent_conversion_no_unknown_key_and_no_change() -> None:
    for wrong in ({"own": "1"}, {"own": 1.0, "more": 2}):
        with pytest.raises(ValidationError):
            Base(**wrong)
    with pytest.raises(ValidationError):
        Base(own=1.0).own = 2.0  # type: ignore[misc]


def test_declared_keys_stand_behind_those_of_the_base_which_keeps_its_own() -> None:
    made = declared("Made", Base, [Key("length"), Key("own", default=9.0)])
    assert list(made.model_fields) == ["own", "length"]
    assert made.model_fields["own"].is_required()
    assert made.model_fields["length"].description == "[m] a length"
    assert made(own=1.0).length == 0.0


def test_the_context_of_a_file_learns_which_model_reads_a_mapping() -> None:
    entered = []

    class Context:
        def enter(self, model: type, data: Any) -> None:
            entered.append((model, data))

    Base.model_validate({"own": 1.0}, context=Context())
    assert entered == [(Base, {"own": 1.0})]


class Resolved(ResolvedModel):
    number: float


def test_a_model_of_right_values_is_equal_to_one_that_was_checked() -> None:
    made = Resolved.of(number=2.0)
    assert made == Resolved(number=2.0)
    assert made.model_fields_set == {"number"}
