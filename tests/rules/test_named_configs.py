"""Every config and folder of configs that a document names is there, and none is left out."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest
from sources import ROOT

from lavendersim.engine.solvers import SOLVER_NAMES

CONFIGS = ROOT / "configs"
PAGES = sorted([*(ROOT / "docs").glob("*.md"), *ROOT.glob("*.md"), CONFIGS / "README.md"])
CODE = re.compile(r"`([^`\n]+)`")


def section(page: Path, title: str) -> str:
    """Return what stands between a heading of a page and the next one."""
    (_, rest) = page.read_text().split(f"## {title}\n")
    return rest.partition("\n## ")[0]


def named_in_rows(text: str) -> list[str]:
    """Return every name in code of the first cells of the tables in a text."""
    cells = re.findall(r"^\| (`[^|]*)\|", text, re.M)
    return sorted(name for cell in cells for name in CODE.findall(cell))


def stems(folder: str) -> list[str]:
    """Return the names of the configs in a folder, without `.yaml`."""
    return sorted(file.stem for file in (CONFIGS / folder).glob("*.yaml"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_a_path_below_configs_leads_somewhere(page: Path) -> None:
    """In running text, in commands and in examples."""
    named = re.findall(r"(?<![\w/])configs/[\w/.-]*[\w/]", page.read_text())
    assert [path for path in named if not (ROOT / path).exists()] == []


def test_every_folder_of_configs_is_described() -> None:
    links = re.findall(r"^\| \[`(\w+)`\]\(([\w/]+)\)", (CONFIGS / "README.md").read_text(), re.M)
    assert all(Path(path).name == name for name, path in links)
    folders = {file.parent for file in CONFIGS.rglob("*.yaml")} | {CONFIGS / "hard"}
    described = sorted(path for _, path in links)
    assert described == sorted(folder.relative_to(CONFIGS).as_posix() for folder in folders)


@pytest.mark.parametrize(
    "folder", [CONFIGS / "hard", ROOT / "tests/configs/bad"], ids=["hard", "bad"]
)
def test_a_folder_groups_configs(folder: Path) -> None:
    """A folder of one file is a longer name; a file beside the folders is in no group."""
    groups = Counter(file.parent for file in folder.rglob("*.yaml"))
    assert folder not in groups
    assert [group.name for group, count in groups.items() if count == 1] == []


def test_the_links_of_the_description_lead_somewhere() -> None:
    targets = re.findall(r"\]\(([^)]+)\)", (CONFIGS / "README.md").read_text())
    assert [target for target in targets if not (CONFIGS / target).exists()] == []


@pytest.mark.parametrize(
    ("title", "folder"),
    [("The scenes", "scenes"), ("The chapter in five experiments", "chapter")],
)
def test_the_results_have_a_row_for_every_config(title: str, folder: str) -> None:
    assert named_in_rows(section(ROOT / "docs/results.md", title)) == stems(folder)


def test_the_matrix_of_solvers_names_hard_cases_that_are_there() -> None:
    """`folder` (case, case): what fails by the files' own names; a folder alone is all of it."""
    page = section(ROOT / "docs/results.md", "The canon of hard cases, by solver")
    listed = page[page.index("Without Newton's method") :]
    named = [
        one
        for one in re.findall(r"`(\w+)`(?:\s\(([^)]+)\))?", listed)
        if one[0] not in SOLVER_NAMES
    ]
    assert named
    for folder, cases in named:
        for case in re.split(r",\s", cases) if cases else []:
            assert (CONFIGS / "hard" / folder / f"{'_'.join(case.split())}.yaml").exists(), case
        assert (CONFIGS / "hard" / folder).is_dir(), folder
