"""Kinds are the models of a package's files, and those of plug-ins that are not taken yet."""

from __future__ import annotations

from importlib.metadata import EntryPoint
from types import ModuleType
from typing import Any, Literal

import pytest

from lavendersim.errors import UsageError
from lavendersim.figures import specs
from lavendersim.figures.specs.base import Panel
from lavendersim.quantities import kinds
from lavendersim.quantities.kinds import all_kinds, kind_of, kinds_in


def module(name: str, kind: Any) -> ModuleType:
    """Return a module that defines a panel of a kind, and imports another."""
    made = ModuleType(name)

    class Own(Panel):
        __module__ = name
        kind: Literal["made"]

    Own.model_fields["kind"].annotation = Literal[kind]  # type: ignore[assignment]
    made.__dict__.update(Own=Own, Panel=Panel, number=3)
    return made


def plugged(monkeypatch: pytest.MonkeyPatch, loaded: Any) -> None:
    """Let an entry point be there that loads a module, or raises."""

    class Entry(EntryPoint):
        def load(self) -> Any:
            if isinstance(loaded, Exception):
                raise loaded
            return loaded

    entry = Entry("own", "own.panels", "lavender.panels")
    monkeypatch.setattr(kinds, "entry_points", lambda group: [entry])


def test_a_module_has_the_kinds_that_it_defines_itself() -> None:
    own = module("own.panels", "made")
    assert kinds_in(own, Panel) == {"made": own.Own}
    assert kind_of(own.Own) == "made"


def test_a_plug_in_stands_behind_the_files_of_the_package(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plugged(monkeypatch, module("own.panels", "made"))
    found = all_kinds(Panel, specs, "lavender.panels")
    assert list(found)[-1] == "made"
    assert {"time_series", "heat_map"} <= found.keys()


def test_a_kind_that_is_taken_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    plugged(monkeypatch, module("own.panels", "heat_map"))
    with pytest.raises(UsageError, match=r"own.panels.*there is a 'heat_map' already"):
        all_kinds(Panel, specs, "lavender.panels")


def test_a_plug_in_that_cannot_be_imported_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    plugged(monkeypatch, ImportError("no module called colours"))
    with pytest.raises(UsageError, match=r"own.panels.*cannot be imported: no module"):
        all_kinds(Panel, specs, "lavender.panels")
