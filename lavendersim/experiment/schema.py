"""The JSON Schema (draft 7) of a config file, with which editors complete and check.

pydantic writes draft 2020-12; what differs is rewritten here. The schema knows types, bounds and
names of keys. What lies between values (a mass or a density, names that must exist) is checked by
the loader alone.
"""

from __future__ import annotations

from typing import Any

from lavendersim.experiment.models.experiment import ExperimentConfig

DRAFT_7 = "http://json-schema.org/draft-07/schema#"
_NAMED_SCHEMAS = ("properties", "patternProperties")
_GENERATED = ("title", "discriminator")  # titles repeat the key, discriminators are OpenAPI's


def json_schema() -> dict[str, Any]:
    """Return the schema of a config file as plain data."""
    written = ExperimentConfig.model_json_schema(ref_template="#/definitions/{model}")
    definitions = written.pop("$defs")
    schema: dict[str, Any] = {"$schema": DRAFT_7, "title": "lavender experiment"}
    schema |= _draft_7(written)
    required = schema.pop("required")  # what a file lacks may stand in the one that it extends
    schema["anyOf"] = [{"required": ["extends"]}, {"required": required}]
    schema["definitions"] = {name: _draft_7(definitions[name]) for name in sorted(definitions)}
    return schema


def _draft_7(schema: Any) -> Any:
    """Return one schema, and all schemas inside it, in the words of draft 7."""
    if isinstance(schema, list):
        return [_draft_7(inner) for inner in schema]
    if not isinstance(schema, dict):
        return schema
    converted: dict[str, Any] = {}
    for key, value in schema.items():
        if key in _NAMED_SCHEMAS:
            converted[key] = {name: _draft_7(inner) for name, inner in value.items()}
        elif key == "prefixItems":  # an array of fixed length
            converted |= {"items": _draft_7(value), "additionalItems": False}
        elif key not in _GENERATED:
            converted[key] = _draft_7(value)
    if "patternProperties" in converted:
        converted.setdefault("additionalProperties", False)
    kind = converted.get("properties", {}).get("kind")
    if kind is not None and "description" in converted:  # what is chosen by this `kind`
        kind.setdefault("description", converted["description"])
    if "$ref" in converted and len(converted) > 1:  # draft 7 ignores what stands beside a $ref
        reference = {"$ref": converted.pop("$ref")}
        converted = {"allOf": [reference], **converted}
    return converted
