"""Self-contained HTML pages from Jinja templates: no network, no other file, at most one script.

Pictures are data and styles stand in the page. The only links are those to the logs, relative to
the page, so that page and runs can be moved together. Every text is escaped by the templates, and
a page's policy lets the player's script run and nothing else.
"""

from __future__ import annotations

import base64
import hashlib
import math
import os
from collections.abc import Sequence, Sized
from importlib.resources import files
from pathlib import Path
from typing import Any, Final, NamedTuple
from urllib.parse import quote

from jinja2 import Environment, PackageLoader, StrictUndefined

from lavendersim.errors import LavenderError, UsageError
from lavendersim.figures.motion import motion
from lavendersim.figures.thumbnail import thumbnail
from lavendersim.quantities.short_times import ON_PAGES, short_time

PLAYER: Final = files("lavendersim.figures") / "templates" / "player.js"
WIDTH, HEIGHT = 160, 110  # dots of a picture, as `thumbnail` draws it


class Picture(NamedTuple):
    """Where the bodies of a cell ended; without data, `text` says why there is none."""

    text: str
    data: str = ""  # a PNG, base64
    width: int = 0
    height: int = 0
    motion: str = ""  # JSON, as `motion` makes it, for the player


def render(template: str, *, has_player: bool = False, **values: Any) -> str:
    """Return a page of `templates/`; a value that the template names must be there."""
    script = PLAYER.read_text("utf-8") if has_player else ""
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    page = {"script": script, "script_digest": digest}
    text = _environment().get_template(template).render(**page, **values)
    return text.encode("utf-8", "replace").decode()  # bytes of a file's name may be no UTF-8


def _environment() -> Environment:
    environment = Environment(
        loader=PackageLoader("lavendersim.figures"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters.update(FILTERS)
    return environment


def check_page_path(path: Path) -> None:
    """Make the folder of a page that is to be written; UsageError where none can be there."""
    if path.suffix not in (".html", ".htm"):
        raise UsageError(f"{path}: the name of this file ends in .html")
    if path.is_dir():
        raise UsageError(f"{path}: a folder has this name")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:  # a file stands where the folder is to be, or it may not be made
        reason = (error.strerror or str(error)).lower()
        raise UsageError(f"{path}: no folder can be made for it: {reason}") from None
    if not os.access(path.parent, os.W_OK):
        raise UsageError(f"{path}: nothing may be written into its folder")


def picture(cell: Any, scale: float = 1.0, *, moving: bool = False) -> Picture:
    """Return the image of where the bodies of a cell ended, at a share of its size.

    moving: with what the player plays.
    """
    try:
        trace = cell.trace()
        data = base64.b64encode(thumbnail(trace)).decode()
        played = motion(trace) if moving else ""
    except LavenderError as error:  # a log that is damaged has no picture, but still a row
        return Picture(str(error))
    finally:
        cell.release()
    text = f"final poses {cell.label}".strip()
    return Picture(text, data, round(scale * WIDTH), round(scale * HEIGHT), played)


def address(path: Path, folder: Path) -> str:
    """Return where a file is as seen from the folder of the page, for an attribute."""
    relative = os.path.relpath(path.resolve(), folder.resolve())
    return quote(os.fsencode(Path(relative).as_posix()))  # also of names that are no UTF-8


def number(value: float) -> str:
    """Return a number with the digits a person can use; a dash for none."""
    if math.isnan(value):
        return "-"
    return f"{value:.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.3g}"


def range_of(numbers: Sequence[float]) -> str:
    """Return the least and the greatest, or the one number that all are."""
    low, high = number(min(numbers)), number(max(numbers))
    return low if low == high else f"{low} to {high}"


def duration(seconds: float) -> str:
    """Return a time in words; nothing for none."""
    return "" if math.isnan(seconds) else short_time(seconds, ON_PAGES)


def count_of(things: Sized, name: str) -> str:
    """Return how many things there are, by their name."""
    return f"{len(things)} {name}{'s' * (len(things) != 1)}"


FILTERS: Final = {
    "number": number,
    "range_of": range_of,
    "duration": duration,
    "count_of": count_of,
}
