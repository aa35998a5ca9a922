"""Numbers, times and addresses as pages have them; a page's texts are escaped."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from lavendersim.errors import LavenderError, UsageError
from lavendersim.figures import html_page
from lavendersim.figures.html_page import (
    address,
    check_page_path,
    count_of,
    duration,
    number,
    picture,
    range_of,
)


@pytest.mark.parametrize(
    ("value", "text"),
    [(1.23456, "1.23"), (1234.5, "1234"), (1e7, "1e+07"), (-2500.4, "-2500"), (math.nan, "-")],
)
def test_numbers_have_digits_that_a_person_can_use(value: float, text: str) -> None:
    assert number(value) == text


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(2.0, "2 s"), (0.0215, "21.5 ms"), (3.2e-5, "32 \u00b5s"), (math.nan, "")],
)
def test_times_have_the_unit_that_leaves_digits_before_the_point(seconds: float, text: str) -> None:
    assert duration(seconds) == text


def test_ranges_and_counts() -> None:
    assert range_of([2.0, 1.0]) == "1 to 2"
    assert range_of([1.0, 1.0 + 1e-9]) == "1"
    assert [count_of("a" * k, "cell") for k in (0, 1, 2)] == ["0 cells", "1 cell", "2 cells"]


def test_an_address_is_relative_and_quoted(tmp_path: Path) -> None:
    log = tmp_path / "runs" / "a b" / "e=0.5.mcap"
    assert address(log, tmp_path / "pages") == "../runs/a%20b/e%3D0.5.mcap"


def test_where_a_page_can_be_written(tmp_path: Path) -> None:
    check_page_path(tmp_path / "new" / "page.html")
    assert (tmp_path / "new").is_dir()
    with pytest.raises(UsageError, match=r"ends in \.html"):
        check_page_path(tmp_path / "page.txt")
    (tmp_path / "folder.html").mkdir()
    with pytest.raises(UsageError, match="a folder has this name"):
        check_page_path(tmp_path / "folder.html")
    (tmp_path / "file").write_text("")
    with pytest.raises(UsageError, match="no folder can be made for it"):
        check_page_path(tmp_path / "file" / "page.html")


class Cell:
    """A cell whose log is damaged, or not."""

    label = "e=0.5"

    def __init__(self, damaged: bool) -> None:
        self.damaged, self.released = damaged, 0

    def trace(self) -> str:
        """Open its log."""
        if self.damaged:
            raise LavenderError("a.mcap: damaged")
        return "trace"

    def release(self) -> None:
        """Close its log."""
        self.released += 1


def test_a_damaged_log_has_its_reason_in_place_of_a_picture(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def drawn(trace: Any) -> bytes:
        return b"PNG"

    monkeypatch.setattr(html_page, "thumbnail", drawn)
    whole, damaged = Cell(False), Cell(True)
    found = picture(whole, 0.5)
    assert (found.text, found.data) == ("final poses e=0.5", "UE5H")
    assert (found.width, found.height) == (80, 55)
    assert picture(damaged) == html_page.Picture("a.mcap: damaged")
    assert whole.released == damaged.released == 1
