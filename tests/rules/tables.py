"""Tables of the documents that are made from the code; `python tests/rules/tables.py` writes them.

Packages and their imports, columns of the log, effects, keys of configs, measures. What a package
does stands in the page.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path

import panel_pages
from config_tables import with_key_tables
from markdown_tables import escaped, markdown
from measure_tables import with_measure_tables
from sources import ROOT
from test_walls import ROOMS

from lavendersim.engine.effects import EFFECTS, Effect
from lavendersim.trace.schema import STEP_COLUMNS

DOCUMENTS = ROOT / "docs"
SYMBOLS = ("v", "gamma")  # a sentence that begins with one keeps its case
# Where an effect's equations stand in theory.md, for those that have some.
SECTIONS = {
    "accelerate": (
        *("gravity", "external_force", "varying_force", "drag", "spring", "kinematic"),
        "prescribed_motion",
    ),
    "collide": ("compound", "broad_phase", "periodic_boundary", "speculative", "fast_bodies"),
    "rows": (
        *("contact_torque", "friction", "frictionless_contact", "rope", "joint"),
        *("joint_stop", "motor"),
        *("stabilisation", "compliance", "restitution", "surface_velocity", "capture_in_sweeps"),
        *("cohesion", "contact_spring", "hertz_contact", "static_friction", "falling_restitution"),
        *("anisotropic_friction", "contact_patch", "tangential_restitution"),
        "tangential_compliance",
    ),
    "impacts-at-the-surface": ("impact_time", "impact_energy"),
    "impacts-in-order": ("impact_order", "pairwise_impacts", "sliding_stops", "overlooked_points"),
    "error-control": ("error_control",),
    "contact-at-the-middle-of-the-step": ("contact_midpoint",),
    "torques-at-a-contact": ("torsional_friction", "rolling_friction"),
    "warm-start": ("warm_start",),
    "newtons-method": ("newton", "supernodes"),
    "packed-sweeps": ("packed_sweeps", "anderson_acceleration"),
    "undetermined-forces": ("least_norm",),
    "projection": ("projection",),
    "integrate": ("rotation", "gyroscopic", "midpoint"),
    "sleeping": ("sleeping",),
    "residual": ("residual_log",),
    "the-law-of-contact": ("problem_log",),
}


def packages(page: str) -> str:
    """Return the table of packages; what each one does is taken from the page."""
    texts = dict(re.findall(r"^\| `(\w+)` \| (.*?) \| [^|]*\|$", page, re.MULTILINE))
    names = [name for name in texts if name in ROOMS]
    names += sorted(ROOMS.keys() - texts.keys() - {"__init__"})
    rows = [
        [f"`{name}`", texts.get(name, ""), ", ".join(sorted(ROOMS[name], key=names.index))]
        for name in names
    ]
    return markdown(["package", "what it does", "may import"], rows)


def step_columns() -> str:
    """Return the table of the columns of /step."""
    rows = [[f"`{column.name}`", escaped(column.meaning)] for column in STEP_COLUMNS]
    return markdown(["column", "meaning"], rows)


def contact_columns() -> str:
    """Return the table of the columns of /contacts, those of every contact first."""
    effects = sorted(EFFECTS, key=lambda effect: effect.name != "contact_log")
    rows = {
        column.name: [f"`{column.name}`", escaped(column.text), f"`{effect.name}`"]
        for effect in reversed(effects)
        for column in reversed(effect.contact_columns)
    }
    return markdown(["column", "meaning", "effect"], list(reversed(rows.values())))


def described(effect: Effect) -> str:
    """Return what an effect is: the first sentence of its file, behind its name."""
    file = ROOT / "lavendersim/engine/effects" / f"{effect.name}.py"
    text = ast.get_docstring(ast.parse(file.read_text())) or ""
    first = text.partition("\n")[0]
    if not first.endswith("."):
        first = " ".join(text.partition("\n\n")[0].split()).partition(". ")[0].rstrip(".") + "."
    sentence = first.partition(": ")[2] or first
    if sentence.split()[0] not in SYMBOLS:
        sentence = sentence[0].upper() + sentence[1:]
    return escaped(sentence)


def effects() -> str:
    """Return the table of effects, in their order."""
    section = {name: place for place, names in SECTIONS.items() for name in names}
    rows = [
        [
            *(
                f"[`{effect.name}`](effects.md#{effect.name})",
                described(effect),
                effect.per,
                ", ".join(effect.needs),
            ),
            f"[theory](theory.md#{section[effect.name]})" if effect.name in section else "",
        ]
        for effect in EFFECTS
    ]
    return markdown(["effect", "what it is", "per", "needs", "equations"], rows)


def with_table(page: str, after: str, table: str) -> str:
    """Return a page whose first table behind a line is this one."""
    place = page.index("\n| ", page.index(after)) + 1
    end = page.find("\n\n", place)
    return page[:place] + table + (page[end:] if end >= 0 else "\n")


def made(name: str) -> str:
    """Return a page of the documents as it should be."""
    if name == "figures.md":
        return panel_pages.page()
    page = (DOCUMENTS / name).read_text()
    if name == "config.md":
        return with_key_tables(page)
    if name == "measures.md":
        return with_measure_tables(page)
    if name == "plan.md":
        return with_table(page, "## Every effect", effects())
    page = with_table(page, "## Packages", packages(page))
    page = with_table(page, "Columns of `/step`", step_columns())
    return with_table(page, "Columns of `/contacts`", contact_columns())


PAGES = ("architecture.md", "config.md", "figures.md", "measures.md", "plan.md")

if __name__ == "__main__":
    for made_page in PAGES:
        Path(DOCUMENTS / made_page).write_text(made(made_page))
