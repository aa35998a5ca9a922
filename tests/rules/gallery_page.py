"""docs/gallery.md: every scene of tests/gallery with its question, its file and a picture.

python tests/rules/gallery_page.py            runs and draws what has no picture; writes the page
python tests/rules/gallery_page.py SCENE...   runs these scenes and draws them anew; writes it
"""

from __future__ import annotations

import re
import sys
import tempfile
from pathlib import Path
from typing import Any, Final

import yaml
from markdown_tables import markdown
from sources import ROOT

SCENES: Final = ROOT / "tests/gallery"
PAGE: Final = ROOT / "docs/gallery.md"
PICTURES: Final = ROOT / "docs/images/gallery"
COLUMNS: Final = 3
DPI: Final = 130  # 208 x 143 dots
HEAD: Final = """\
# Gallery

Scenes of ten lines or so, as a teacher, a game developer or a roboticist writes them in the first
hour: shapes, surfaces, velocities and a duration, and nothing of how they are simulated. Each is
run by the tests at the [defaults](config.md#numerics), with `always: {}`: it comes to its end,
every step converges, nothing is warned of, and what it claims, from a closed form where there is
one, is met. The files lie in `tests/gallery`: `lavender run tests/gallery/pendulum.yaml`. Pictures
show where bodies began, in light grey, and where they ended.
"""
NOT_YET: Final = """\
## Not yet

These do not run as they should, and lie in `tests/gallery/not_yet`:
"""
# What a scene has, and the section that it stands in: the first that holds.
JOINED, DRIVEN = "Joints, ropes and springs", "Pushed, carried and changed"
FLOATING = "Without gravity"
BALLS, BOXES, OTHERS = "Balls", "Boxes", "Cylinders and several shapes"
SECTIONS: Final = (BALLS, BOXES, OTHERS, FLOATING, DRIVEN, JOINED)
DRIVES: Final = ("kinematic", "surface_velocity", "drag")


def scenes(folder: Path = SCENES) -> list[Path]:
    """Return the scenes of a folder, by their names."""
    return sorted(folder.glob("*.yaml"))


def section(config: dict[str, Any]) -> str:
    """Return the section of the page that a scene belongs to."""
    scene = config["scene"]
    own = list(scene.get("bodies", {}).values())
    own += [one["body"] for one in scene.get("arrangements", {}).values()]
    shapes = [body["shape"] for body in own]
    shapes = [scene["shapes"][one] if isinstance(one, str) else one for one in shapes]
    movable = {one["kind"] for one in shapes} - {"plane"}
    if "connections" in scene or "springs" in scene:
        return JOINED
    driven = any(key in body for body in own for key in DRIVES)
    if driven or "forces" in scene or "events" in config:
        return DRIVEN
    if scene.get("gravity") == 0:
        return FLOATING
    return BALLS if movable == {"sphere"} else BOXES if movable == {"box"} else OTHERS


def page() -> str:
    """Return docs/gallery.md as it should be."""
    read = {file: yaml.safe_load(file.read_text()) for file in scenes()}
    parts = [HEAD]
    for title in SECTIONS:
        own = [file for file, config in read.items() if section(config) == title]
        parts.append(f"## {title}\n")
        cells = [_cell(file, read[file]) for file in own]
        cells += [""] * (-len(cells) % COLUMNS)
        rows = [cells[k : k + COLUMNS] for k in range(0, len(cells), COLUMNS)]
        parts.append(markdown([""] * COLUMNS, rows))
        parts.append("")
    parts.append(NOT_YET)
    rows = [_row(file) for file in not_yet()]
    parts.append(markdown(["scene", "question", "what is wrong"], rows))
    return "\n".join(parts)


def not_yet() -> list[Path]:
    """Return the scenes that do not run as they should."""
    return scenes(SCENES / "not_yet")


def reason(file: Path) -> str:
    """Return what a scene says is wrong with it: the comment behind its `always`."""
    found = re.search(r"^always: \{.*?\} # (.+)$", file.read_text(), re.MULTILINE)
    return found[1] if found else ""


def _cell(file: Path, config: dict[str, Any]) -> str:
    question = config["question"]
    picture = f"![{question}](images/gallery/{file.stem}.png)"
    return f"{picture}<br>{question}<br>[{file.stem}.yaml](../tests/gallery/{file.stem}.yaml)"


def _row(file: Path) -> list[str]:
    return [f"`{file.stem}`", yaml.safe_load(file.read_text())["question"], reason(file)]


def drawn(file: Path) -> Path:
    """Return where the picture of a scene lies."""
    return PICTURES / f"{file.stem}.png"


def draw(file: Path) -> None:
    """Run a scene and draw it."""
    import lavendersim
    from lavendersim.figures.thumbnail import thumbnail

    with tempfile.TemporaryDirectory() as folder:
        finished = lavendersim.run(file, root=Path(folder))
        PICTURES.mkdir(parents=True, exist_ok=True)
        (cell,) = finished.run.cells
        drawn(file).write_bytes(thumbnail(cell.trace(), DPI))


if __name__ == "__main__":
    named = [SCENES / f"{name}.yaml" for name in sys.argv[1:]]
    for each in named or [one for one in scenes() if not drawn(one).exists()]:
        draw(each)
    for left in set(PICTURES.glob("*.png")) - {drawn(one) for one in scenes()}:
        left.unlink()
    PAGE.write_text(page())
