"""Cells of two runs at the same coordinates are compared; those without a partner are named."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.comparison.pairing import paired, partner
from lavendersim.errors import UsageError


def cell(**coordinates: Any) -> Any:
    """Return a cell at these coordinates."""
    label = ", ".join(f"{axis}={value}" for axis, value in coordinates.items())
    return SimpleNamespace(coordinates=coordinates, label=label)


def run(*cells: Any) -> Any:
    """Return a run of cells."""
    return SimpleNamespace(cells=list(cells), path=Path("run"))


def test_cells_at_the_same_coordinates_in_the_order_of_the_first_run() -> None:
    a, b = [cell(e=0.5), cell(e=0.1), cell(e=0.9)], [cell(e=0.1), cell(e=0.5), cell(e=0.3)]
    found = paired(a, b)
    assert [(pair.label, pair.a, pair.b) for pair in found.pairs] == [
        ("e=0.5", a[0], b[1]),
        ("e=0.1", a[1], b[0]),
    ]
    assert (found.only_a, found.only_b) == (["e=0.9"], ["e=0.3"])
    assert found.axes == ("e",)


def test_an_axis_of_one_run_alone_pairs_where_it_leaves_one_cell() -> None:
    a = [cell(e=0.5, mu=0.1)]
    assert len(paired(a, [cell(e=0.5)]).pairs) == 1
    two = paired([*a, cell(e=0.5, mu=0.2)], [cell(e=0.5)])
    assert two.pairs == []
    assert two.only_a == ["e=0.5, mu=0.1", "e=0.5, mu=0.2"]


def test_runs_without_a_sweep_are_one_pair() -> None:
    found = paired([cell()], [cell()])
    assert len(found.pairs) == 1
    assert found.axes == ()


def test_a_cell_without_a_partner_is_named() -> None:
    a, b = run(cell(e=0.5), cell(e=0.1)), run(cell(e=0.1))
    assert partner(a, a.cells[1], b) == 0
    with pytest.raises(UsageError, match=r"no one cell at the coordinates of e=0\.5"):
        partner(a, a.cells[0], b)
