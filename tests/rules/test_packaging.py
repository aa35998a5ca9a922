"""What is installed: every package with its type marker, and lower bounds that install together."""

from __future__ import annotations

import re
import tomllib
from typing import Any

from sources import PACKAGES, ROOT

PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())
# `numpy>=2.0`: the name and the bound of a requirement; extras and markers are not in use.
REQUIREMENT = re.compile(r"(?P<name>[A-Za-z0-9_-]+)>=(?P<bound>[0-9.]+)$")


def test_every_package_is_listed() -> None:
    found = {
        ".".join([name, *file.parent.relative_to(ROOT / folder).parts])
        for folder, name in PACKAGES.items()
        for file in (ROOT / folder).rglob("__init__.py")
    }
    assert set(PROJECT["tool"]["setuptools"]["packages"]) == found


def test_types_are_announced() -> None:
    data = PROJECT["tool"]["setuptools"]["package-data"]
    for folder, name in PACKAGES.items():
        assert (ROOT / folder / "py.typed").is_file()
        assert "py.typed" in data[name]


def test_files_that_are_no_modules_are_installed_too() -> None:
    data = PROJECT["tool"]["setuptools"]["package-data"]
    installed = {
        file
        for name, patterns in data.items()
        for pattern in patterns
        for file in (ROOT / _folder(name)).glob(pattern)
    }
    there = {
        file
        for folder in PACKAGES
        for file in (ROOT / folder).rglob("*")
        if file.is_file() and file.suffix not in (".py", ".pyc", ".nbi", ".nbc")
    }
    assert there - installed == set()


def _folder(package: str) -> str:
    top, *below = package.split(".")
    (folder,) = (folder for folder, name in PACKAGES.items() if name == top)
    return "/".join([folder, *below])


def test_the_lowest_dependencies_are_the_lower_bounds() -> None:
    """CI installs `.github/lowest.txt`: bounds that nobody installs are guesses."""
    pins = dict(line.split("==") for line in (ROOT / ".github/lowest.txt").read_text().split())
    bounds = {}
    for requirement in PROJECT["project"]["dependencies"]:
        match = REQUIREMENT.fullmatch(requirement)
        assert match, requirement
        bounds[match["name"]] = match["bound"]
    assert set(pins) == set(bounds)
    for name, bound in bounds.items():
        # 2.0.0 is the lowest release of 2.0
        assert pins[name] == bound or pins[name] == f"{bound}.0", name
