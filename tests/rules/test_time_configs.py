"""Configs of configs/time say how their errors go with the timestep, show it, and have controls.

docs/results.md lists them, each with an order or as exact, and the reason.
"""

from __future__ import annotations

import re
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml
from sources import ROOT

FILES = sorted((ROOT / "configs/time").glob("*.yaml"))
TABLE = re.compile(r"^\| config \| .*\n\|[- |]+\n((?:\|.*\n)+)", re.M)
FEWEST = 3  # numbers that tell an order, or that there is no error
# The path whose values an error is held against.
TIMESTEP, ACCURACY = "numerics.timestep", "numerics.accuracy"


@cache
def listed() -> dict[str, tuple[str, str]]:
    """Return each row of the table: of a config what it claims, and the reason."""
    page = (ROOT / "docs/results.md").read_text()
    found = TABLE.search(page, page.index("## Accuracy in time"))
    assert found
    rows = [[cell.strip(" `") for cell in row.split("|")[1:-1]] for row in found[1].splitlines()]
    return {name: (claim, reason) for name, claim, reason in rows}


@cache
def config(file: Path) -> dict[str, Any]:
    read: dict[str, Any] = yaml.safe_load(file.read_text())
    return read


def products(file: Path) -> list[dict[str, Any]]:
    """Return the parts of the sweep, each a product of axes by their names."""
    sweep = config(file)["sweep"]
    return sweep if isinstance(sweep, list) else [sweep]


def axes_along(file: Path, path: str) -> set[str]:
    """Return the names of axes along a path that have enough values."""
    return {
        name
        for product in products(file)
        for name, axis in product.items()
        if axis.get("path") == path and len({Fraction(v) for v in axis["values"]}) >= FEWEST
    }


def axis_of_error(file: Path) -> set[str]:
    """Return the names of the axis that the claim of a config is along."""
    asked = listed()[file.stem][0] == "as asked for"
    return axes_along(file, ACCURACY if asked else TIMESTEP)


def orders(file: Path) -> list[dict[str, Any]]:
    return [one["order"] for one in config(file)["expect"] if "order" in one]


def test_the_results_list_every_config() -> None:
    assert sorted(listed()) == [file.stem for file in FILES]


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_config_claims_the_order_that_is_listed_or_is_exact(file: Path) -> None:
    claim, reason = listed()[file.stem]
    assert re.fullmatch(r"order 2(, and exact)?|exact|as asked for", claim)
    assert len(reason.split()) >= 5, "no reason"
    assert axis_of_error(file)
    assert bool(orders(file)) == claim.startswith("order 2")
    # Bounds from below: what converges faster than that is no second order either, but passes.
    if orders(file):
        assert max(one.get("at_least", 0) for one in orders(file)) >= 1.6
        assert all({one["along"]} <= axis_of_error(file) for one in orders(file))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_config_shows_its_error(file: Path) -> None:
    panels = config(file)["figure"]["panels"]
    assert {panel.get("axis") for panel in panels} <= axis_of_error(file)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_config_has_a_control_that_must_fail(file: Path) -> None:
    """`fails` passes where that one claim fails and nothing else does; in cells that are there."""
    controls = [one for one in config(file)["expect"] if "fails" in one]
    assert controls
    for control in controls:
        assert all(
            any(value in (product.get(name) or {}).get("values", ()) for product in products(file))
            for name, value in control["at"].items()
        )
