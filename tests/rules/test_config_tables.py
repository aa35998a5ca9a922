"""docs/config.md names every key of a config, and the presets' own numbers."""

from __future__ import annotations

import re
from typing import Annotated

import pytest
from config_tables import models_below
from pydantic import BaseModel
from sources import ROOT

from lavendersim.cell import Numerics
from lavendersim.engine.effects import SCENE_KEYS
from lavendersim.experiment.checks.messages import fields
from lavendersim.experiment.models.experiment import ExperimentConfig
from lavendersim.experiment.resolve.presets import PRESETS
from lavendersim.figures.specs.catalogue import FigureSpec
from lavendersim.measures.specs.catalogue import MeasureSpec
from lavendersim.measures.specs.expectation import ExpectSpec
from lavendersim.quantities.chosen_kind import kinds
from lavendersim.quantities.scalars import label, resolve

TEXT = (ROOT / "docs/config.md").read_text(encoding="utf-8")
ROWS = {
    cells[1].strip("` "): [cell.strip() for cell in cells[2:4]]
    for line in TEXT.partition("## numerics")[2].partition("## sweep")[0].splitlines()
    if len(cells := line.split("|")) == 6 and cells[1].startswith(" `")
}
# Kinds of these are listed by `lavender schema`.
ELSEWHERE = models_below(
    tuple[MeasureSpec, ExpectSpec, FigureSpec]  # type: ignore[valid-type]
)
MODELS = [model for model in models_below(ExperimentConfig) if model not in ELSEWHERE]


def test_every_model_has_a_table_or_is_described_in_words() -> None:
    tables = re.findall(r"<!-- \w+: ([\w ]+) -->", TEXT)
    shown = {name for names in tables for name in names.split()}
    in_words = {"ArrangedBody", "AxisAngle", "Effects", "Reduced", "Window"}
    of_effects = {
        model.__name__ for key in SCENE_KEYS for model in models_below(Annotated[key.type, ""])
    }
    others = {model.__name__ for model in MODELS} - shown - of_effects
    assert others == {*in_words, "NumericsSource"}


def test_models_are_found() -> None:
    assert {"Scene", "Body", "Hull", "Tower", "Force", "Event"} <= {m.__name__ for m in MODELS}


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.__name__)
def test_every_key_and_kind_is_named(model: type[BaseModel]) -> None:
    code = " ".join(re.findall(r"`[^`]+`|```.*?```", TEXT, re.DOTALL))
    words = set(fields(model)) | set(kinds(model))
    missing = [word for word in words if not re.search(rf"\b{re.escape(word)}\b", code)]
    assert missing == []


@pytest.mark.parametrize(("column", "preset"), list(enumerate(PRESETS)))
def test_table_of_numerics_has_the_presets_numbers(column: int, preset: str) -> None:
    documented = {key: row[column] for key, row in ROWS.items()}
    assert set(documented) == set(Numerics.model_fields)
    for key, value in PRESETS[preset]:
        assert label(resolve(documented[key])) == label(value), key
