"""docs/figures.md: every kind of panel with a picture, its lines of a shipped config, and its keys.

python tests/rules/panel_pages.py    runs those configs and draws the pictures anew
"""

from __future__ import annotations

import sys
import tempfile
import textwrap
from pathlib import Path
from typing import Final

import yaml
from config_tables import keys_table
from markdown_tables import markdown
from sources import ROOT

from lavendersim.figures.specs.base import Level, Panel
from lavendersim.figures.specs.catalogue import KINDS
from lavendersim.figures.specs.ideal import Ideal

PICTURES: Final = ROOT / "docs/images/panels"
# The shipped config whose figure shows a kind, and which of its panels of that kind.
SHOWN: Final = {
    "measure_against_axis": ("chapter/timestep_and_compliance", 1),
    "time_series": ("chapter/impact_telemetry", 0),
    "trajectory": ("language/passages", 0),
    "histogram": ("language/spread_of_rebounds", 0),
    "heat_map": ("language/rolling_bodies", 0),
    "row_against_index": ("chapter/warm_start", 0),
    "measure_by_name": ("cost/law_violations", 0),
    "stability_map": ("hard/maps/mass_ratio", 0),
    "free_rotation": ("scenes/free_rotation", 0),
}
HEAD: Final = """\
# Figures

`figure` of a config has a caption and one to six panels, drawn from the logs of a run by
`lavender run --plot` or `lavender plot`. A panel shows the cells that `at` selects, all of them
without one. Colours are Okabe and Ito's, which colour-blind readers tell apart, and every series
has a marker or a line of its own, too. More than five series of numbers are lines of one sequential
scale. What is not a number has no point: a legend or a caption says how many there are.

Other packages add kinds of their own, see [Recipes](extending.md).

## Keys of every panel
"""


def config_of(kind: str) -> Path:
    """Return the shipped config that shows a kind of panel."""
    return ROOT / "configs" / f"{SHOWN[kind][0]}.yaml"


def page() -> str:
    """Return docs/figures.md as it should be."""
    parts = [HEAD, _keys(Panel, ()), "\nOf `levels` and `ideal`:\n", _keys(Level, ()), ""]
    parts += [_keys(Ideal, ()), ""]
    for kind in SHOWN:
        model = KINDS[kind]
        meaning = textwrap.fill(" ".join((model.__doc__ or "").split()), 119)
        parts += [f"## {kind}", f"{meaning}\n", f"![{_title(kind)}](images/panels/{kind}.png)\n"]
        parts += [f"```yaml\n{_lines(kind)}\n```\n", f"From `configs/{SHOWN[kind][0]}.yaml`.\n"]
        parts += [_keys(model, {*Panel.model_fields, "kind"}), ""]
    return "\n".join(parts)


def _keys(model: type, without: object) -> str:
    heads, *rows = keys_table(model)
    rows = [row for row in rows if row[0].strip("`") not in without]  # type: ignore[operator]
    return markdown(heads, rows)


def _index(kind: str) -> int:
    """Return which panel of its config's figure is shown."""
    panels = yaml.safe_load(config_of(kind).read_text())["figure"]["panels"]
    return [k for k, one in enumerate(panels) if one["kind"] == kind][SHOWN[kind][1]]


def _title(kind: str) -> str:
    panel = yaml.safe_load(config_of(kind).read_text())["figure"]["panels"][_index(kind)]
    return f"{kind}: {panel.get('title') or panel['y_label']}"


def _lines(kind: str) -> str:
    """Return the lines of the panel in its config, from its kind on."""
    node = yaml.compose(config_of(kind).read_text())
    for key in ("figure", "panels"):
        node = next(value for name, value in node.value if name.value == key)
    panel = node.value[_index(kind)]
    begin, end = panel.start_mark.index, panel.end_mark.index
    lines = (" " * panel.start_mark.column + config_of(kind).read_text()[begin:end]).rstrip()
    return "- " + textwrap.indent(textwrap.dedent(lines), "  ").lstrip()


def draw(kind: str) -> None:
    """Run the config of a kind and draw its panel alone."""
    from matplotlib import style

    import lavendersim
    from lavendersim.figures.config_figure import compose
    from lavendersim.figures.style import STYLE

    with tempfile.TemporaryDirectory() as folder:
        finished = lavendersim.run(config_of(kind), root=Path(folder))
        experiment = finished.run.experiment
        figure = experiment.config.figure
        # Question and caption are of the whole figure.
        alone = figure.model_copy(update={"panels": (figure.panels[_index(kind)],), "caption": ""})
        shown = experiment.config.model_copy(update={"figure": alone, "question": ""})
        object.__setattr__(experiment, "config", shown)
        PICTURES.mkdir(parents=True, exist_ok=True)
        with style.context(STYLE):
            picture = compose(experiment, list(finished.run.cells))
            picture.savefig(PICTURES / f"{kind}.png", dpi=100)


if __name__ == "__main__":
    for drawn in sys.argv[1:] or SHOWN:
        draw(drawn)
