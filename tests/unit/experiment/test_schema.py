"""The schema for editors is sound draft 7, takes every good config and refuses bad ones."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft7Validator

from lavendersim.experiment import load_experiment
from lavendersim.experiment.schema import json_schema
from lavendersim.experiment.text.parse import parse
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.scalars import Ratio

ROOT = Path(__file__).parents[3]
GOOD = sorted(ROOT.glob("configs/*/*.yaml"))
BAD = ROOT / "tests" / "configs" / "bad"

WORDS_OF_2020 = {"$defs", "prefixItems", "discriminator", "dependentRequired"}


def plain(value: Any) -> Any:
    """Return what an editor's YAML 1.2 reader gives: ratios are texts, sequences lists."""
    if isinstance(value, Ratio):
        return repr(value)
    if isinstance(value, tuple):
        return [plain(item) for item in value]
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    return value


def read(path: Path) -> Any:
    report = Report(path.name)
    root = parse(path.read_bytes(), report)
    assert root is not None
    assert not report.defects
    return plain(root.data)


def schemas(schema: Any) -> Iterator[dict[str, Any]]:
    """Yield every mapping in the schema."""
    if isinstance(schema, dict):
        yield schema
        for value in schema.values():
            yield from schemas(value)
    elif isinstance(schema, list):
        for value in schema:
            yield from schemas(value)


@pytest.fixture(scope="module")
def whole() -> dict[str, Any]:
    return json_schema()


@pytest.fixture(scope="module")
def validator(whole: dict[str, Any]) -> Draft7Validator:
    return Draft7Validator(whole)


def test_schema_is_sound_draft_7(whole: dict[str, Any]) -> None:
    Draft7Validator.check_schema(whole)
    assert json.loads(json.dumps(whole)) == whole
    for schema in schemas(whole):
        assert not WORDS_OF_2020 & set(schema)
        if "$ref" in schema:
            assert set(schema) == {"$ref"}, "draft 7 ignores what stands beside a $ref"
            assert schema["$ref"].rpartition("/")[2] in whole["definitions"]


def test_every_key_is_described(whole: dict[str, Any]) -> None:
    for name, definition in {**whole["definitions"], "": whole}.items():
        for key, schema in definition.get("properties", {}).items():
            assert schema.get("description"), f"{name}.{key} has no description"


def test_there_are_good_configs() -> None:
    assert len(GOOD) >= 12


@pytest.mark.parametrize("path", GOOD, ids=lambda path: path.stem)
def test_good_config_loads_and_fits_the_schema(path: Path, validator: Draft7Validator) -> None:
    assert load_experiment(path).cells()
    assert [error.message for error in validator.iter_errors(read(path))] == []


@pytest.mark.parametrize(
    "case",
    [
        "unknown_key",
        "unknown_key_at_the_top",
        "misspelt_required_key",
        "missing_duration",
        "missing_kind",
        "unknown_shape",
        "unusable_body_name",
        "wrong_type",
        "text_for_a_number",
        "vector_too_short",
        "negative_mass",
        "restitution_above_one",
        "timestep_zero",
        "unit_milliseconds",
        "unknown_preset",
        "sweep_without_values",
        "unknown_measure_kind",
        "many_defects",
        "hull_of_three_points",
        "hull_point_of_two_numbers",
        "compound_of_nothing",
        "compound_of_a_plane",
        "friction_negative",
        "arrangement_without_kind",
        "arrangement_of_planes",
        "tower_of_none",
        "gravity_of_negative_slope",
        "impacts_unknown",
        "drag_misspelt",
    ],
)
def test_bad_config_does_not_fit_the_schema(case: str, validator: Draft7Validator) -> None:
    root = parse(next(BAD.rglob(f"{case}.yaml")).read_bytes(), Report(case))
    assert root is not None
    assert not validator.is_valid(plain(root.data))
