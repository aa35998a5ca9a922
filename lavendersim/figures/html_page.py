"""Words, a cell's log and a body of HTML in; the parts of a page and the whole page out.

No script, no network, no other file: pictures are data, styles stand in the page. The only links
are those to the logs, relative to the page, so that page and runs can be moved together.
"""

from __future__ import annotations

import base64
import os
from html import escape
from pathlib import Path
from typing import Any, Final
from urllib.parse import quote

from lavendersim.errors import LavenderError, UsageError
from lavendersim.figures.thumbnail import thumbnail

WIDTH, HEIGHT = 160, 110  # dots of a picture, as `thumbnail` draws it
STYLE: Final = """
body { font: 15px/1.45 sans-serif; color: #222; background: #fff; margin: 2em auto;
  max-width: 80em; padding: 0 1em; }
h1 { font-size: 1.5em; margin-bottom: 0.2em; }
table { border-collapse: collapse; width: 100%; }
th { text-align: left; font-weight: normal; color: #666; }
th, td { padding: 0.4em 0.8em 0.4em 0; vertical-align: top; border-bottom: 1px solid #ddd; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td.picture { width: 160px; }
.pass { color: #00694c; font-weight: bold; }
.fail { color: #b04a00; font-weight: bold; }
.small { color: #666; font-size: 0.87em; }
pre { background: #f5f5f5; padding: 0.6em; overflow-x: auto; font-size: 0.87em; }
details table { margin: 0.4em 0; font-size: 0.93em; }
summary { cursor: pointer; }
img { background: #fff; border: 1px solid #ddd; }
"""


def document(title: str, body: str, style: str = "") -> str:
    """Return a whole page; `style` follows what all pages have."""
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>{escape(title)}</title>
<style>{STYLE}{style}</style>
</head>
<body>
{body}
</body>
</html>
"""


def make_room(path: Path) -> None:
    """Make the folder of a page that is to be written; UsageError where none can be there."""
    if path.suffix not in (".html", ".htm"):
        raise UsageError(f"{path}: the name of this file ends in .html")
    if path.is_dir():
        raise UsageError(f"{path}: a folder has this name")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:  # a file stands where the folder is to be, or it may not be made
        told = (error.strerror or str(error)).lower()
        raise UsageError(f"{path}: no folder can be made for it: {told}") from None
    if not os.access(path.parent, os.W_OK):
        raise UsageError(f"{path}: nothing may be written into its folder")


def write_whole(text: str, path: Path) -> None:
    """Write a page in one move: a reader sees the old or the new one, never half."""
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_name(f".{path.name}.{os.getpid()}.unfinished")
    try:
        unfinished.write_text(text, encoding="utf-8")
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)


def picture(cell: Any, scale: float = 1.0) -> str:
    """Return an image of where the bodies of a cell ended, at a share of its size."""
    try:
        data = base64.b64encode(thumbnail(cell.trace())).decode()
    except LavenderError as error:  # a log that is damaged has no picture, but still a row
        return f'<span class="small">{escape(str(error))}</span>'
    finally:
        cell.release()
    said = escape(f"final poses {cell.label}".strip(), quote=True)
    size = f'width="{scale * WIDTH:.0f}" height="{scale * HEIGHT:.0f}"'
    return f'<img {size} alt="{said}" src="data:image/png;base64,{data}">'


def address(path: Path, folder: Path) -> str:
    """Return where a file is as seen from the folder of the page, for an attribute."""
    relative = os.path.relpath(path.resolve(), folder.resolve())
    return escape(quote(Path(relative).as_posix()), quote=True)
