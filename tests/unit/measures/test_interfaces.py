"""What measures need of logs and cells is what logs, sections and cells of runs have."""

from __future__ import annotations

import inspect

import pytest

from lavendersim.measures import interfaces
from lavendersim.measures.sections import Section
from lavendersim.runner.run_directory import RunCell
from lavendersim.trace.reader import Trace
from lavendersim.trace.written_trace import WrittenTrace


def needed(protocol: type) -> dict[str, object]:
    return {name: one for name, one in vars(protocol).items() if not name.startswith("_")}


def members(kind: type) -> set[str]:
    """Return what instances have: attributes of classes, and those that are set or annotated."""
    found = set(dir(kind))
    for base in kind.__mro__:
        found |= set(inspect.get_annotations(base))
        if base.__module__.startswith("lavendersim"):
            source = inspect.getsource(base)
            found |= {word.split(" ")[0].split(":")[0] for word in source.split("self.")[1:]}
    return found


@pytest.mark.parametrize("kind", [Trace, WrittenTrace, Section])
def test_logs_have_what_measures_take(kind: type) -> None:
    assert needed(interfaces.Trace).keys() <= members(kind)


def test_cells_of_runs_have_what_judgements_take() -> None:
    assert needed(interfaces.Cell).keys() <= members(RunCell)


@pytest.mark.parametrize("kind", [Trace, WrittenTrace, Section])
def test_what_is_called_takes_no_more_than_the_interface_gives(kind: type) -> None:
    for name, one in needed(interfaces.Trace).items():
        if inspect.isfunction(one):
            expected = list(inspect.signature(one).parameters)
            assert list(inspect.signature(getattr(kind, name)).parameters) == expected
