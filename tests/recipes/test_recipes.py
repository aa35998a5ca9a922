"""The recipes of docs/extending.md: each patch is applied to a copy of lavender, and used there.

A recipe is a section with a sentence `Touches N files.`, its patch as a `diff` block, and, as a
`yaml` block, an experiment that only lavender with the patch takes and whose expectations it meets.
One for another package has a `toml` block, its pyproject.toml, and a `python` block, its module.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.forked_python import python

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/extending.md"
SECTION = re.compile(r"^## (?P<name>.+)\n(?P<text>(?:(?!^## ).*\n)*)", re.MULTILINE)
BLOCK = re.compile(r"^```(?P<language>\w+)\n(?P<content>.*?)^```$", re.DOTALL | re.MULTILINE)
KNOWN = r"takes\sthe\sexperiment\swithout\sthe\spatch"
# Files that a recipe may touch at most: what the design promises.
MOST_FILES = {
    "A measure": 2,
    "A solver": 2,
    "An option of the numerics": 2,
    "A shape that is a hull": 4,
    "A shape with kernels of its own": 4,
}
LAVENDER = "import sys; from lavender_cli.main import main; sys.argv[0] = 'lavender'; main()"


class Recipe(NamedTuple):
    """One section of the page."""

    name: str
    files: int  # as the page says
    is_known: bool  # lavender takes the experiment without the recipe, too
    blocks: dict[str, str]  # by language

    @property
    def experiment(self) -> str:
        """The config that the recipe makes possible."""
        return self.blocks["yaml"]

    def modules(self) -> set[str]:
        """Return the modules that the patch adds, as a plan names them: `pairs.sphere_hull`."""
        added = re.findall(r"^--- /dev/null\n\+\+\+ b/(.+)\.py$", self.blocks["diff"], re.MULTILINE)
        return {".".join(Path(file).parts[-2:]) for file in added}

    def touched(self) -> set[str]:
        """Return the files of lavender that it changes or adds."""
        return set(re.findall(r"^\+\+\+ b/(.+)$", self.blocks.get("diff", ""), re.MULTILINE))


def recipes() -> list[Recipe]:
    """Return the recipes of the page."""
    found = []
    for section in SECTION.finditer(PAGE.read_text()):
        blocks = {m["language"]: m["content"] for m in BLOCK.finditer(section["text"])}
        counts = re.findall(r"Touches\s(\d+)\sfiles?\.", section["text"])
        assert len(counts) == ("diff" in blocks), f"{section['name']}: how many files?"
        is_known = bool(re.search(KNOWN, section["text"]))
        found.append(Recipe(section["name"], int(counts[0]) if counts else 0, is_known, blocks))
    return found


RECIPES = recipes()


class Copy:
    """A copy of lavender, used by processes of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        for package in ("lavendersim", "cli"):
            without = shutil.ignore_patterns("*.pyc.*")  # bytecode that others are writing
            shutil.copytree(ROOT / package, folder / package, ignore=without)
        (folder / "lavender_cli").symlink_to("cli")

    def apply(self, patch: str) -> None:
        """Apply a patch; the lines around a change are looked for, their numbers say little."""
        subprocess.run(
            ["git", "apply", "--whitespace=nowarn", "-"],
            cwd=self.folder,
            # What stands in a repository above is not meant.
            env=os.environ | {"GIT_CEILING_DIRECTORIES": str(self.folder.parent)},
            input=patch,
            text=True,
            check=True,
        )

    def install(self, project: str, module: str) -> None:
        """Do what pip does: put the module where Python finds it, with its entry points."""
        about = tomllib.loads(project)["project"]
        name = f"{about['name'].replace('-', '_')}-{about['version']}.dist-info"
        metadata = self.folder / name
        metadata.mkdir()
        head = f"Metadata-Version: 2.1\nName: {about['name']}\nVersion: {about['version']}\n"
        (metadata / "METADATA").write_text(head)
        lines = []
        for group, entries in about["entry-points"].items():
            lines.append(f"[{group}]")
            for key, value in entries.items():
                lines.append(f"{key} = {value}")
                (self.folder / f"{value}.py").write_text(module)
        (metadata / "entry_points.txt").write_text("\n".join(lines))

    def lavender(self, *arguments: object) -> subprocess.CompletedProcess[str]:
        """Run the command line of the copy; -P: not that of the working directory."""
        return subprocess.run(
            [sys.executable, "-P", "-c", LAVENDER, *map(str, arguments)],
            cwd=self.folder,
            env=os.environ | {"PYTHONPATH": str(self.folder), "NO_COLOR": "1"},
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )


def test_the_page_has_recipes() -> None:
    assert len(RECIPES) >= 2
    assert len({recipe.name for recipe in RECIPES}) == len(RECIPES)


@pytest.mark.parametrize("recipe", RECIPES, ids=lambda recipe: recipe.name)
def test_a_recipe_touches_as_many_files_as_it_says(recipe: Recipe) -> None:
    assert len(recipe.touched()) == recipe.files
    assert recipe.files <= MOST_FILES.get(recipe.name, recipe.files)


@pytest.mark.parametrize("recipe", RECIPES, ids=lambda recipe: recipe.name)
def test_a_recipe_works(recipe: Recipe, tmp_path: Path) -> None:
    copy = Copy(tmp_path)
    config = tmp_path / "recipe.yaml"
    config.write_text(recipe.experiment)
    # The copy is lavender as it is: what that says needs no process that imports the copy.
    before = python("-m", "lavender_cli.main", "check", config, where=tmp_path)
    assert before.returncode == (0 if recipe.is_known else 2), before.stdout + before.stderr
    if "diff" in recipe.blocks:
        copy.apply(recipe.blocks["diff"])
    else:
        copy.install(recipe.blocks["toml"], recipe.blocks["python"])
    after = copy.lavender("run", config, "--plot")
    assert after.returncode == 0, after.stdout + after.stderr
    assert "pass" in after.stdout
    if recipe.is_known:
        plan = copy.lavender("plan", config).stdout
        assert [module for module in recipe.modules() if module not in plan] == []


def test_a_measure_of_another_package_is_listed_with_its_unit(tmp_path: Path) -> None:
    (recipe,) = (one for one in RECIPES if one.name == "A measure of another package")
    copy = Copy(tmp_path)
    copy.install(recipe.blocks["toml"], recipe.blocks["python"])
    line = copy.lavender("measures").stdout.splitlines()[-1]
    name, unit, meaning = line.split(maxsplit=2)
    assert (name, unit) == ("path_length", "m")
    assert meaning.endswith("over the whole run  (of contact_lab_path)")
