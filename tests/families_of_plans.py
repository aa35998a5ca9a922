"""Plans that shipped configs share where the suite runs them, as the cells of one sweep do.

A kernel takes five to twenty seconds to compile, and shipped configs differ in little. Each family
here is planned as the cells of one sweep are (`runner.plans`): one plan, the union, for all that
make the same choices between laws. A config whose plan is a part of a family's has that one. What
it has beside what the config requires is idle there and changes no bit (tests/composition: each
effect alone, and random subsets).

Some effects do change something where they are added, and never are (`NEVER_ADDED`): with
`impact_order` an impact of one pair alone has its rows in its own step and none in the next one;
with `rotation` places of frictionless balls that slide differ in their last bit; with
`residual_log` sweeps are counted that change nothing.

The suite runs shipped configs so, but for the chapter's (`ConfigsSharePlans`, which
tests/conftest.py registers); `pytest configs`, and everybody else, runs each by its own plan.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from lavendersim.engine.spec import Spec
from lavendersim.experiment import load_experiment
from lavendersim.experiment.cell import Cell
from lavendersim.scene.plan import Plan

NEVER_ADDED = {"error_control", "impact_order", "packed_sweeps", "residual_log", "rotation"}
CONFIGS = Path(__file__).parents[1] / "configs"
CHAPTER = CONFIGS / "chapter"
# The first that has what a config requires is taken.
FAMILIES = (
    ("time/ball_on_ball", "scenes/bullet", "time/corner_of_three_walls"),
    ("chapter/timestep_and_compliance", "paw_check/two_movable_masses"),
    ("scenes/pile", "scenes/pyramid"),
    (
        *("time/turntable", "time/ball_on_turntable", "time/slope", "time/disc_that_nods"),
        *("time/heavy_top", "time/flush_seams", "time/box_between_walls", "scenes/rod_end"),
        *("scenes/rest", "scenes/frictional_rod", "effects/table", "language/rolling_bodies"),
        *("language/changes_during_a_run", "hard/removed_load/top_ball_deleted"),
        *("hard/friction/wedge_jam", "hard/friction/conveyor", "hard/restitution/cube_on_slab"),
    ),
    ("time/cradle_with_gaps", "time/near_miss"),
    ("time/accuracy_of_energy", "time/accuracy_of_rolling"),
    ("effects/varying_force",),
    ("scenes/oblique_impact",),
    ("hard/tall/jenga",),
)


def spec_of_family(plan: Plan) -> Spec:
    """Return what is compiled for a plan: a family's that has all of it, or its own."""
    required = set(plan.spec.effects)
    for family in _families():
        spec = family.spec
        if plan.choices != family.choices or plan.spec[2:] != spec[2:]:
            continue
        if not required <= set(spec.effects) or NEVER_ADDED & (set(spec.effects) - required):
            continue
        if set(plan.spec.shape_pairs) <= set(spec.shape_pairs):
            return spec
    return plan.spec


@cache
def _families() -> tuple[Plan, ...]:
    from lavendersim.runner.plans import distinct, shared_plans

    plans: list[Plan] = []
    for names in FAMILIES:
        cells: list[Cell] = []
        for name in names:
            cells += load_experiment(CONFIGS / f"{name}.yaml", True).cells()
        plans += distinct(shared_plans(cells))
    return tuple(plans)


def with_specs_of_families(plans: Iterable[Plan]) -> list[Plan]:
    """Return plans of cells with what is compiled for them; one object stays one object."""
    known: dict[int, Plan] = {}
    found = []
    for plan in plans:
        if id(plan) not in known:
            known[id(plan)] = plan._replace(spec=spec_of_family(plan))
        found.append(known[id(plan)])
    return found


class ConfigsSharePlans:
    """A plugin: shipped configs that run as a part of the whole suite share plans."""

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Any:
        """Let the plan of a shipped config be a family's."""
        if not item.path.is_relative_to(CONFIGS) or item.path.is_relative_to(CHAPTER):
            return (yield)
        from lavendersim.runner import planning, plans

        def joined_by_families(parts: Sequence[plans.Decided]) -> list[Plan]:
            return with_specs_of_families(plans.joined(parts))

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(planning, "joined", joined_by_families)
            return (yield)
