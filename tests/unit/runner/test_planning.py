"""Cells planned in shares of several processes are planned as each of them by itself is."""

from __future__ import annotations

import os
import sys

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import Experiment, load_experiment_text
from lavendersim.experiment import cell as cell_module
from lavendersim.runner import planning, workers
from lavendersim.runner.cell_jobs import prepare
from lavendersim.runner.planning import log_of, planned
from lavendersim.scene.plan import plan_of_cell, union

# Effects that some cells require and others do not, a choice between laws, and an axis of starts.
SWEPT = """scene:
  bodies:
    floor: {shape: {kind: plane}, surface: {friction: 1}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1
      release: {above: floor, clearance: 0.1}
duration: 0.1
sweep:
  law: {path: numerics.solver, values: [projected_gauss_seidel, nonsmooth_conjugate_gradient]}
  mu: {path: scene.bodies.ball.surface.friction, values: [0, 0.3]}
  e: {path: scene.bodies.ball.surface.restitution, values: [0, 0.5, 0.8]}
  h: {path: scene.bodies.ball.release.clearance, values: [0.1, 0.2, 0.3, 0.4]}
"""
SOURCE = "a digest"

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes are forked on Linux")


@pytest.fixture(autouse=True)
def always_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a few cells be worth several processes, whatever threads pytest has."""
    monkeypatch.setattr(planning, "WORTH_PROCESSES", 2)
    for module in (planning, workers):
        monkeypatch.setattr(module, "may_fork", lambda: True)


def swept(text: str = SWEPT) -> Experiment:
    return load_experiment_text(text, "swept.yaml")


def unbuilt() -> Experiment:
    """Return the same sweep, of which no cell is built yet, as large sweeps are."""
    return swept().refined(3).refined(2)


@pytest.mark.parametrize("processes", [1, 2, 3])
def test_plans_names_and_configs_are_those_of_each_cell_by_itself(processes: int) -> None:
    expected = unbuilt().cells()
    own = [plan_of_cell(cell) for cell in expected]
    choices = dict.fromkeys(plan.choices for plan in own)
    shared = {one: union([plan for plan in own if plan.choices == one]) for one in choices}
    cells = unbuilt().cells()
    found = planned(cells, SOURCE, processes)
    assert len(shared) == 2
    for plan, by_itself in zip(found.plans, own, strict=True):
        truth = shared[by_itself.choices]
        assert plan.spec == truth.spec
        assert plan.cells == truth.cells
        for name in truth.decisions | truth.shape_pairs:
            assert plan.described(name) == truth.described(name)
            assert plan.reasons_of(name) == truth.reasons_of(name)
    assert found.logs == [log_of(cell, SOURCE) for cell in expected]
    assert len(set(found.logs)) == len(cells)
    assert [cell.config.as_json() for cell in cells] == [cell.config.as_json() for cell in expected]
    assert [cell.config for cell in cells] == [cell.config for cell in expected]


def test_a_plan_is_one_object_for_all_cells_that_share_it() -> None:
    plans = planned(unbuilt().cells(), SOURCE, 2).plans
    assert len({*map(id, plans)}) == 2


@pytest.mark.parametrize("processes", [1, 2, 3])
def test_what_some_cells_are_refused_for_is_said_once_and_in_the_order_of_the_file(
    processes: int,
) -> None:
    """Cells without friction, and those that do not rebound, are not refused."""
    cells = swept(SWEPT + "effects: {restitution: off, friction: off}\n").cells()
    with pytest.raises(ConfigError) as alone:
        planned(cells, SOURCE, 1)
    with pytest.raises(ConfigError) as found:
        planned(cells, SOURCE, processes)
    assert found.value.defects == alone.value.defects
    lines = str(found.value).splitlines()
    assert ["restitution" in lines[0], "friction" in lines[1]] == [True, True]
    assert len(lines) == 2


def test_a_share_whose_process_dies_is_planned_here(monkeypatch: pytest.MonkeyPatch) -> None:
    here, plan = os.getpid(), planning._found

    def dies_elsewhere(share: planning._Share) -> planning._Found:
        if os.getpid() != here and share.cells[0].index == 0:
            os._exit(3)
        return plan(share)

    expected = planned(unbuilt().cells(), SOURCE, 1)
    monkeypatch.setattr(planning, "_found", dies_elsewhere)
    assert planned(unbuilt().cells(), SOURCE, 2) == expected


def test_jobs_are_the_same_for_any_number_of_processes() -> None:
    one, two = prepare(unbuilt(), 1), prepare(unbuilt(), 2)
    assert one.plans == two.plans
    assert one.logs == two.logs


def test_no_cell_is_built_again_by_the_process_that_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    cells = unbuilt().cells()
    planned(cells, SOURCE, 2)
    monkeypatch.setattr(cell_module, "build_cell", None)
    assert len({cell.config.as_json() for cell in cells}) == len(cells)
