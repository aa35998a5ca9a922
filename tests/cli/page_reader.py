"""A page that `lavender` wrote, as its elements and its text."""

from __future__ import annotations

import re
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path

import pytest

VOID = {"meta", "img", "br", "wbr", "input"}
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")


class Page(HTMLParser):
    """Elements, links and text of a page; every tag that opens must close."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: list[tuple[str, dict[str, str]]] = []
        self.text = ""
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.seen.append((tag, {name: value or "" for name, value in attrs}))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data

    def all(self, tag: str, kind: str = "") -> list[dict[str, str]]:
        """Return the attributes of every such element."""
        return [at for name, at in self.seen if name == tag and at.get("class", "") == kind]

    def needs_nothing_else(self) -> None:
        """Hold it to what a page that stands alone may name; of scripts to its own and to data."""
        assert {"link", "iframe", "object"}.isdisjoint(tag for tag, _ in self.seen)
        scripts = [at for tag, at in self.seen if tag == "script"]
        assert all(at in ({}, {"type": "application/json"}) for at in scripts)
        (policy,) = (at["content"] for _, at in self.seen if "http-equiv" in at)
        assert policy.startswith("default-src 'none'; img-src data:; style-src 'unsafe-inline'")
        named = [at[key] for _, at in self.seen for key in at if key in ("href", "src", "action")]
        assert not [name for name in named if name.startswith(("http", "/", "file"))]


def opened_in_a_browser(page: Path, scratch: Path, width: int = 1200) -> Page:
    """Return what a browser makes of a page so many pixels wide; skips where there is none."""
    return Page(_browse(page, scratch, f"--window-size={width},1400", "--dump-dom"))


def sheets(page: Path, scratch: Path) -> int:
    """Return how many sheets of paper a browser prints a page on; skips where there is none."""
    _browse(page, scratch, f"--print-to-pdf={scratch / 'printed.pdf'}")
    return len(re.findall(rb"/Type\s*/Page\b", (scratch / "printed.pdf").read_bytes()))


def _browse(page: Path, scratch: Path, *options: str) -> str:
    found = [path for name in BROWSERS if (path := shutil.which(name))]
    if not found:
        pytest.skip(f"no browser here: none of {', '.join(BROWSERS)} is installed")
    always = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={scratch}"]
    done = subprocess.run(
        [found[0], *always, *options, page.as_uri()],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    return done.stdout
