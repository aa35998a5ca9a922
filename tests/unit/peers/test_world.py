"""Every engine has an adapter: one file under 150 lines, which its authors can correct."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from lavendersim.peers import adapters
from lavendersim.peers.catalogue import PEERS
from lavendersim.peers.world import BoundedWorld, CountingWorld, World

MOST_LINES = 150
FOLDER = Path(adapters.__file__).parent


@pytest.mark.parametrize("name", PEERS)
def test_an_adapter_is_short_and_has_every_method(name: str) -> None:
    text = (FOLDER / f"{name}.py").read_text()
    assert len(text.splitlines()) < MOST_LINES
    (world,) = (
        node
        for node in ast.parse(text).body
        if isinstance(node, ast.ClassDef) and node.name == "World"
    )
    has = {node.name for node in world.body if isinstance(node, ast.FunctionDef)}
    assert {name for name in vars(World) if not name.startswith("_")} <= has
    counts = {name for name in vars(CountingWorld) if not name.startswith("_")}
    assert (counts <= has) == PEERS[name].counted
    bounds = {name for name in vars(BoundedWorld) if not name.startswith("_")}
    assert (bounds <= has) == PEERS[name].bounded


def test_every_adapter_is_of_an_engine() -> None:
    assert {file.stem for file in FOLDER.glob("*.py")} - {"__init__"} == set(PEERS)
