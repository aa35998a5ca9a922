"""`lavender open`: which files it shows, and that it says where there is no program for them."""

from __future__ import annotations

from pathlib import Path

import pytest
import typer
from command_line import lavender

from tests.drop_config import DROP

FIGURE = """figure:
  caption: A ball.
  panels:
    - {kind: time_series, column: position_z, body: ball, title: height, x_label: t, y_label: z}
"""


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    where = tmp_path_factory.mktemp("drawn")
    (where / "drop.yaml").write_text(DROP + FIGURE)
    assert lavender("run", "drop.yaml", "--plot", where=where).returncode == 0
    return where


def opened(drawn: Path, *words: object) -> list[str]:
    done = lavender("open", *words, "--print", where=drawn)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_of_a_run_its_figure_and_where_there_is_a_page_that(drawn: Path) -> None:
    (run,) = (drawn / "runs").glob("2*")
    figure = opened(drawn)
    assert [Path(one).suffix for one in figure] == [".png"]
    assert (drawn / figure[0]).is_file()
    assert opened(drawn, run.name) == figure
    page = run / "cost.html"
    page.write_text("<p>a page</p>")
    assert opened(drawn) == [str(page.relative_to(drawn))]
    page.unlink()


def test_of_a_file_that_file(drawn: Path) -> None:
    (drawn / "report.html").write_text("<p>a report</p>")
    assert opened(drawn, "report.html") == ["report.html"]
    done = lavender("open", "drop.yaml", where=drawn)
    assert (done.returncode, "expected a page (.html) or a figure" in done.stderr) == (2, True)


def test_a_run_without_any_says_what_draws_one(tmp_path: Path) -> None:
    (tmp_path / "drop.yaml").write_text(DROP)
    assert lavender("run", "drop.yaml", where=tmp_path).returncode == 0
    done = lavender("open", where=tmp_path)
    assert done.returncode == 2
    assert "neither a page nor a figure; `lavender plot` draws its figure" in done.stderr


@pytest.mark.parametrize(("code", "is_refused"), [(0, False), (1, True)])
def test_the_file_is_handed_to_the_desktop_or_it_says_that_none_takes_it(
    code: int, is_refused: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from lavender_cli.open import open_
    from lavendersim.errors import MissingDriverError

    page = tmp_path / "report.html"
    page.write_text("<p>a report</p>")
    launched: list[str] = []

    def launch(url: str) -> int:
        launched.append(url)
        return code

    monkeypatch.setattr(typer, "launch", launch)
    if is_refused:
        with pytest.raises(MissingDriverError, match="no program was found"):
            open_(page)
    else:
        open_(page)
    assert launched == [str(page)]
