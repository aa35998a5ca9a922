"""A finished run in; its figure as PNG and SVG out. The only room that imports matplotlib."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def draw(run: Any, directory: Path) -> list[Path]:
    """Draw the figure of a run (`.experiment`, `.cells`); returns the files written.

    matplotlib is imported here and not before: it takes a quarter of a second.
    """
    from lavendersim.figures.page import draw as draw_page

    return draw_page(run, directory)
