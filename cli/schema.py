"""`lavender schema`: prints the JSON Schema of config files."""

from __future__ import annotations

from lavender_cli import printing


def schema() -> None:
    """Print the JSON Schema (draft 7) of config files, for editors."""
    from lavendersim.experiment.schema import json_schema

    printing.as_json(json_schema())
