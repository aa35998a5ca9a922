"""Cells that share a choice of laws share an engine; cells that differ in it have one a choice."""

from __future__ import annotations

from pathlib import Path

import pytest
from small_configs import DROPS, write

import lavendersim
from lavendersim.experiment import load_experiment_text
from lavendersim.runner import Finished, Progress
from lavendersim.runner.plans import distinct, shared_plans
from lavendersim.runner.progress import Compilation
from lavendersim.scene.plan import CHOICES

SOLVERS = "[projected_gauss_seidel, nonsmooth_conjugate_gradient]"
SWEPT = DROPS.replace("sweep:\n", "sweep:\n  law: {path: %s, values: %s}\n")
VALUES = {
    "solver": SOLVERS,
    "speculative": "[false, true]",
    "impacts": "[captured, at_surface]",
    "simultaneous_impacts": "[together, pairwise]",
    "integrator": "[semi_implicit_euler, midpoint]",
    "compliance_law": "[spring, regularised]",
    "undetermined_forces": "[least_norm, as_solved]",
    "friction_cone": "[disc, convex]",
    "order": "[coloured, random]",
    "sleeping": "[false, true]",
    "mistake": "[none, capture_in_sweeps]",
    "effects": "[on, off]",
}
PATHS = {name: f"numerics.{name}" for name in VALUES} | {
    "mistake": "study.mistake",
    "effects": "effects.friction",
}


def test_every_choice_can_be_swept() -> None:
    # Of an accuracy see below; engines are swept by `tests/cli/test_engine_option.py`.
    assert {*VALUES, "error_control", "engine"} == set(CHOICES)


def test_cells_with_an_accuracy_share_an_engine_and_those_without_another() -> None:
    """An axis has no value for none; a union of products has cells without the axis."""
    e = "e: {path: scene.bodies.ball.surface.restitution, values: [0.2, 0.5, 0.8]}"
    asked = "accuracy: {path: numerics.accuracy, values: [1e-2, 1e-4]}"
    text = DROPS.replace("numerics: chapter", "numerics: default")
    text = text.replace(f"  {e}\n", f"  - {{{e}}}\n  - {{{e}, {asked}}}\n")
    plans = shared_plans(load_experiment_text(text, "swept.yaml").cells())
    controlled = [plan.spec.has("error_control") for plan in plans]
    assert controlled == [False] * 3 + [True] * 6
    assert len(distinct(plans)) == 2


@pytest.mark.parametrize("choice", VALUES)
def test_cells_are_grouped_by_the_choice(choice: str) -> None:
    cells = load_experiment_text(SWEPT % (PATHS[choice], VALUES[choice]), "swept.yaml").cells()
    plans = shared_plans(cells)
    assert len(plans) == 6  # two values of the choice times three of e
    # the first axis is the slowest, so the cells of a choice stand together
    assert len({id(plan) for plan in plans[:3]}) == len({id(plan) for plan in plans[3:]}) == 1
    assert [one.choices for one in distinct(plans)] == [plans[0].choices, plans[3].choices]
    values = {plan.choices[CHOICES.index(choice)] for plan in plans}
    assert len(values) == 2


def test_cells_that_differ_in_over_relaxation_share_an_engine() -> None:
    """A factor, no law: where no cell has one, no code has it."""
    for values, relaxed in (("[1]", False), ("[1, 1.5]", True)):
        text = SWEPT % ("numerics.over_relaxation", values)
        plans = shared_plans(load_experiment_text(text, "swept.yaml").cells())
        assert len(distinct(plans)) == 1
        assert plans[0].spec.over_relaxation == relaxed


def test_an_effect_of_one_group_stays_out_of_the_other() -> None:
    cells = load_experiment_text(
        SWEPT % ("numerics.speculative", "[false, true]"), "swept.yaml"
    ).cells()
    plans = shared_plans(cells)
    assert [plan.spec.has("speculative") for plan in plans] == [False] * 3 + [True] * 3


class Swept:
    """One sweep over solvers, run once, and the plans that were announced as compiled."""

    def __init__(self, folder: Path, jobs: int) -> None:
        self.compiled: list[str] = []
        # e = 0.2 alone: what is asked here is a matter of plans
        text = (SWEPT % ("numerics.solver", SOLVERS)).replace("[0.2, 0.5, 0.8]", "[0.2, 0.8]")
        text = text[: text.index("measure:\n")]

        def compiling(begun: Compilation) -> None:
            self.compiled.append(begun.plan.spec.solver)

        config = write(folder, text, "swept.yaml")
        self.finished: Finished = lavendersim.run(
            config, root=folder / "runs", jobs=jobs, progress=Progress(compiling=compiling)
        )


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Swept:
    return Swept(tmp_path_factory.mktemp("swept"), jobs=1)


def test_each_cell_runs_with_its_own_solver(swept: Swept) -> None:
    logged = [cell.trace().metadata["engine"]["solver"] for cell in swept.finished.run.cells]
    configured = [cell.trace().config.numerics.solver for cell in swept.finished.run.cells]
    assert logged == configured
    assert len(set(logged)) == 2
    assert all(outcome.status == "complete" for outcome in swept.finished.outcomes)


def test_no_plan_is_compiled_twice(swept: Swept) -> None:
    assert len(set(swept.compiled)) == len(swept.compiled) <= 2


def test_processes_change_neither_order_nor_bytes(swept: Swept, tmp_path: Path) -> None:
    pooled = Swept(tmp_path, jobs=2).finished
    assert [outcome.cell for outcome in pooled.outcomes] == [0, 1, 2, 3]
    for one, other in zip(pooled.run.cells, swept.finished.run.cells, strict=True):
        assert one.label == other.label
        assert one.path.read_bytes() == other.path.read_bytes()
