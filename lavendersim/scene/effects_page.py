"""The page on the effects, written from their declarations and the docstrings of their files.

python -m lavendersim.scene.effects_page docs/effects.md
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import fields
from importlib import import_module
from inspect import cleandoc
from pathlib import Path

from lavendersim.engine.effects import EFFECTS, Column, Effect
from lavendersim.engine.effects.keys import Key
from lavendersim.engine.terms import RowTerms, StepTerms

INTRODUCTION = """\
# Effects

Every term of the physics and of the log is declared in one file of `lavendersim/engine/effects`,
and is a line of the list there. A scene's plan has the effects that the scene requires (`lavender
plan`); the others leave no code, no array and no column. This page is written from the declarations
(`python -m lavendersim.scene.effects_page docs/effects.md`).
"""


def page() -> str:
    """Return the page as Markdown."""
    sections = [INTRODUCTION, *("\n".join(_section(effect)) + "\n" for effect in EFFECTS)]
    return "\n".join(sections)


def _section(effect: Effect) -> Iterator[str]:
    module = import_module(f"lavendersim.engine.effects.{effect.name}")
    first, _, rest = cleandoc(module.__doc__ or "").partition("\n")
    yield f"## {effect.name}\n"
    yield f"{first}\n"
    if rest.strip():
        yield f"```text\n{rest.strip()}\n```\n"
    if effect.needs:
        yield f"Needs {', '.join(f'`{name}`' for name in effect.needs)}.\n"
    terms = [term.name for term in fields(RowTerms) if getattr(effect.row, term.name)]
    if terms:
        yield f"Brings to contacts' rows the term {', '.join(f'`{term}`' for term in terms)}.\n"
    step = [term.name for term in fields(StepTerms) if getattr(effect.step, term.name)]
    if step:
        yield f"Brings to steps the term {', '.join(f'`{term}`' for term in step)}.\n"
    if effect.chosen_by:
        yield f"Chosen by `{effect.chosen_by.section}.{effect.chosen_by.key}`.\n"
    keys: list[tuple[str, Key]] = [
        *(("surface", key) for key in effect.surface_keys),
        *(("body", key) for key in effect.body_keys),
        *(("scene", key) for key in effect.scene_keys),
    ]
    if keys:
        yield "| key | default | meaning |"
        yield "|---|---|---|"
        for section, key in keys:
            yield f"| `{section}.{key.name}` | {_default(key.default)} | {_cell(key.doc)} |"
        yield ""
    columns = [("/contacts", effect.contact_columns), ("/step", effect.step_columns)]
    columns.append(("/residuals", effect.residual_columns))
    if any(group for _, group in columns):
        yield "| column | of | meaning |"
        yield "|---|---|---|"
        for topic, group in columns:
            yield from (_column(topic, column) for column in group)
        yield ""


def _default(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else "none"


def _column(topic: str, column: Column) -> str:
    return f"| `{column.name}` | `{topic}` | {_cell(column.text)} |"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(page(), encoding="utf-8")
