"""`lavender check --report`: one page that needs nothing else, escapes all words, and opens."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from pathlib import Path
from urllib.parse import unquote

import pytest
from command_line import lavender
from page_reader import Page, opened_in_a_browser, sheets

from tests.drop_config import DROP

HOSTILE = '<script src="http://example.com/x.js">alert("1 & 2")</script>'


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A case that passes, one, with hostile words, of which a cell fails, and one that must."""
    folder = tmp_path_factory.mktemp("reported")
    swept = DROP.replace("How high?", f"'{HOSTILE}'") + (
        "sweep:\n  e: {path: scene.bodies.ball.surface.restitution, values: [0.5, 0.9]}\n"
    )
    (folder / "good.yaml").write_text(DROP)
    (folder / "so so.yaml").write_text(swept)
    must = DROP.replace("[0.02, 0.03]", "[0.2, 0.3]") + "  - {name: too low, fails: rebound}\n"
    (folder / "z.yaml").write_text(must)
    done = lavender(
        *("check", "good.yaml", "so so.yaml", "z.yaml", "--report", "pages/report.html"),
        where=folder,
    )
    assert done.returncode == 1, done.stderr
    return folder / "pages" / "report.html"


def test_there_is_a_row_for_every_case_and_cell(report: Path) -> None:
    page = Page(report.read_text(encoding="utf-8"))
    assert [row["data-case"] for row in page.all("tr", "case")] == ["good", "so so", "z"]
    assert len(page.all("tr", "cell")) == 4
    for words in ("2 of 3 cases pass", "3 of 4 claims met in 4 cells", "rebound at e=0.9: FAILED"):
        assert words in page.text


def test_a_pass_by_a_declared_failure_says_so(report: Path) -> None:
    rows = report.read_text(encoding="utf-8").split('<tr class="case"')[1:]
    assert ["rebound fails, as declared" in row for row in rows] == [False, False, True]


def test_no_text_below_a_row_can_widen_it(report: Path) -> None:
    page = Page(report.read_text(encoding="utf-8"))
    (heads,) = (i for i, (_, at) in enumerate(page.seen) if at.get("class") == "cases")
    columns = [tag for tag, _ in page.seen[heads : heads + 20]].count("th") - 1  # of the picture
    wide = [at["colspan"] for tag, at in page.seen if tag == "td" and "colspan" in at]
    assert wide == [str(columns)] * 3
    assert len(page.all("tr", "more")) == 3


def test_the_page_needs_nothing_else(report: Path) -> None:
    page = Page(report.read_text(encoding="utf-8"))
    page.needs_nothing_else()
    pictures = page.all("img")
    assert len(pictures) == 3
    for picture in pictures:
        kind, _, data = picture["src"].partition(",")
        assert kind == "data:image/png;base64"
        assert base64.b64decode(data, validate=True).startswith(b"\x89PNG\r\n\x1a\n")
    assert "url(" not in report.read_text(encoding="utf-8")


def test_every_link_leads_to_a_log(report: Path) -> None:
    page = Page(report.read_text(encoding="utf-8"))
    links = [link["href"] for link in page.all("a")]
    assert len(links) == 3 + 4
    for link in links:
        log = report.parent / unquote(link)
        assert log.suffix == ".mcap"
        assert log.is_file()


def test_words_of_a_config_are_words(report: Path) -> None:
    text = report.read_text(encoding="utf-8")
    assert "<script src" not in text
    assert HOSTILE in Page(text).text


def test_the_player_alone_may_run(report: Path) -> None:
    text = report.read_text(encoding="utf-8")
    (script,) = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"; script-src 'sha256-{digest}'\"" in text
    played = re.findall(r'<script type="application/json">(.*?)</script>', text, re.DOTALL)
    assert [len(json.loads(one)["bodies"]) for one in played] == [1, 1, 1]


def test_a_page_of_another_name_is_refused(report: Path) -> None:
    done = lavender("check", "good.yaml", "--report", "page.pdf", where=report.parents[1])
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "page.pdf: the name of this file ends in .html\n"


@pytest.mark.parametrize(
    ("page", "why"),
    [
        ("good.yaml/page.html", "no folder can be made for it: file exists"),
        ("good.yaml/pages/page.html", "no folder can be made for it: not a directory"),
        ("pages.html", "a folder has this name"),
    ],
)
def test_a_page_that_cannot_be_is_reported_before_anything_runs(
    report: Path, page: str, why: str
) -> None:
    where = report.parents[1]
    (where / "pages.html").mkdir(exist_ok=True)
    before = sorted((where / "runs").iterdir())
    done = lavender("check", "good.yaml", "--report", page, where=where)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"{page}: {why}\n"
    assert sorted((where / "runs").iterdir()) == before


def test_the_page_opens_in_a_browser(report: Path, tmp_path: Path) -> None:
    page = opened_in_a_browser(report, tmp_path)
    assert [row["data-case"] for row in page.all("tr", "case")] == ["good", "so so", "z"]


@pytest.mark.parametrize("width", [500, 900, 1500])
def test_no_row_reaches_into_the_next(report: Path, tmp_path: Path, width: int) -> None:
    """By the boxes of a browser: each row of the table, with all in it, ends where the next begins.

    A pixel is for rounding; a picture spans the row of its case and what belongs to it.
    """
    asked = """<script>
      const rows = [...document.querySelectorAll(".cases > tbody > tr")];
      const end = row => Math.max(...[...row.querySelectorAll(":scope > td:not(.picture)")]
        .map(cell => cell.getBoundingClientRect().bottom));
      document.body.dataset.overlaps = rows.slice(1).filter(
        (row, k) => end(rows[k]) > row.getBoundingClientRect().top + 1).length;
    </script></body>"""
    text = re.sub(r"<meta http-equiv[^>]*>", "", report.read_text())  # which allows no other script
    copy = tmp_path / "copy.html"
    copy.write_text(text.replace("</body>", asked))
    page = opened_in_a_browser(copy, tmp_path / "browser", width)
    (body,) = (at for tag, at in page.seen if tag == "body")
    assert body["data-overlaps"] == "0"


def test_what_is_folded_is_printed(report: Path, tmp_path: Path) -> None:
    """Tables of claims take paper, of which a page with its `details` closed has none."""
    text = report.read_text()
    folded = tmp_path / "folded.html"
    folded.write_text(re.sub(r"details\S*::details-content", "i", text))
    assert folded.read_text() != text
    assert sheets(report, tmp_path) > sheets(folded, tmp_path)
