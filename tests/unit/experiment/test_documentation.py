"""docs/config.md names every key of a config, and the presets' own numbers."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pydantic import BaseModel

from lavendersim.cell import Numerics
from lavendersim.experiment.checks.annotations import (
    alternatives,
    annotation_of,
    field_name,
    is_model,
    kinds,
)
from lavendersim.experiment.models.experiment import ExperimentConfig
from lavendersim.experiment.resolve.presets import PRESETS
from lavendersim.quantities.scalars import resolve, written

TEXT = (Path(__file__).parents[3] / "docs" / "config.md").read_text(encoding="utf-8")
ROWS = {
    cells[1].strip("` "): [cell.strip() for cell in cells[2:4]]
    for line in TEXT.partition("## numerics")[2].partition("## sweep")[0].splitlines()
    if len(cells := line.split("|")) == 6 and cells[1].startswith(" `")
}
# Kinds of these are listed by `lavender schema`.
ELSEWHERE = {"measure", "expect", "figure"}


def models_below(annotation: object) -> set[type[BaseModel]]:
    """Every model that a config of this type may hold."""
    found: set[type[BaseModel]] = set()
    for member, _ in alternatives(annotation):
        if is_model(member):
            found.add(member)
            for name, info in member.model_fields.items():
                if name not in ELSEWHERE:
                    found |= models_below(annotation_of(info))
        else:
            for inner in getattr(member, "__args__", ()):
                if inner is not Ellipsis and not isinstance(inner, str):
                    found |= models_below(inner)
    return found


MODELS = sorted(models_below(ExperimentConfig), key=lambda model: model.__name__)


def test_models_are_found() -> None:
    assert {"Scene", "Body", "Hull", "Tower", "Force", "Event"} <= {m.__name__ for m in MODELS}


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.__name__)
def test_every_key_and_kind_is_named(model: type[BaseModel]) -> None:
    code = " ".join(re.findall(r"`[^`]+`|```.*?```", TEXT, re.DOTALL))
    words = {field_name(model, name) for name in model.model_fields} | set(kinds(model))
    missing = [word for word in words if not re.search(rf"\b{re.escape(word)}\b", code)]
    assert missing == []


@pytest.mark.parametrize(("column", "preset"), list(enumerate(PRESETS)))
def test_table_of_numerics_has_the_presets_numbers(column: int, preset: str) -> None:
    stated = {key: row[column] for key, row in ROWS.items()}
    assert set(stated) == set(Numerics.model_fields)
    for key, value in PRESETS[preset]:
        assert written(resolve(stated[key])) == written(value), key
