"""Plans that scenes of many files share, as the cells of one sweep do.

A kernel takes five to twenty seconds to compile, and scenes of tests and shipped configs differ in
little. Each family here is planned as the cells of one sweep are (`runner.plans`): one plan, the
union, for all that make the same choices between laws. A scene whose plan is a part of a family's
has that one. What it has beside what the scene requires is idle there and changes no bit
(tests/composition: each effect alone, and random subsets); so it was for every scene of these files
and every config when it was shared.

Some effects do change something where they are added, and never are (`NEVER_ADDED`): with
`impact_order` an impact of one pair alone has its rows in its own step and none in the next one;
with `rotation` places of frictionless balls that slide differ in their last bit; with
`residual_log` sweeps are counted that change nothing.

The suite runs shipped configs so, but for the chapter's (`ConfigsSharePlans`, which
tests/conftest.py registers); `pytest configs`, and everybody else, runs each by its own plan.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from lavendersim.engine.spec import Spec
from lavendersim.experiment import load_experiment, load_experiment_text
from lavendersim.experiment.cell import Cell
from lavendersim.scene.plan import Plan

# Whatever tests of physics require of lavender's own numerics, in one scene.
SCENE = """
scene:
  surfaces: {one: {friction: 0.5, restitution: 0.5}, two: {friction: 0}}
  bodies:
    floor: {shape: {kind: plane}, surface: one}
    belt:
      shape: {kind: box, size: [1, 1, 1]}
      fixed: true
      position: [5, 0, 1]
      surface_velocity: [1, 0, 0]
      surface: one
    lift:
      shape: {kind: box, size: [1, 1, 1]}
      kinematic: true
      velocity: [1, 0, 0]
      position: [9, 0, 1]
      surface: two
    brick:
      shape: {kind: box, size: [0.2, 0.1, 0.3]}
      mass: 1
      position: [0, 0, 1]
      velocity: [9, 0, 0]
      angular_velocity: [1, 2, 3]
      surface: one
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [1, 0, 1], surface: one}
    low: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [2, 0, 1], surface: two}
duration: 1
"""
PAIRS = (
    *("box_box", "box_plane", "capsule_box", "capsule_plane", "cylinder_box", "cylinder_cylinder"),
    *("cylinder_plane", "hull_plane", "sphere_box", "sphere_cylinder", "sphere_plane"),
    "sphere_sphere",
)
NEVER_ADDED = {"error_control", "impact_order", "packed_sweeps", "residual_log", "rotation"}
CONFIGS = Path(__file__).parents[1] / "configs"
CHAPTER = CONFIGS / "chapter"
# Behind the scene above; the first that has what a scene requires is taken.
FAMILIES = (
    ("time/ball_on_ball", "scenes/bullet", "time/corner_of_three_walls"),
    ("chapter/timestep_and_compliance", "paw_check/two_movable_masses"),
    ("scenes/pile", "scenes/pyramid"),
    ("time/turntable", "time/ball_on_turntable", "time/slope", "time/disc_that_nods"),
    ("time/cradle_with_gaps", "time/near_miss"),
    ("time/accuracy_of_energy", "time/accuracy_of_rolling"),
    ("effects/varying_force",),
    ("scenes/oblique_impact",),
    ("hard/tall/jenga",),
)


def shared_spec(plan: Plan) -> Spec:
    """Return what is compiled for a plan: a family's plan that has all of it, or its own."""
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

    scene = load_experiment_text(SCENE, "shared.yaml").cells()
    (first,) = distinct(shared_plans(scene))
    plans = [first._replace(spec=first.spec._replace(shape_pairs=PAIRS))]
    for names in FAMILIES:
        cells: list[Cell] = []
        for name in names:
            cells += load_experiment(CONFIGS / f"{name}.yaml", True).cells()
        plans += distinct(shared_plans(cells))
    return tuple(plans)


def with_shared_specs(plans: Iterable[Plan]) -> list[Plan]:
    """Return plans of cells with what is compiled for them; one object stays one object."""
    known: dict[int, Plan] = {}
    found = []
    for plan in plans:
        if id(plan) not in known:
            known[id(plan)] = plan._replace(spec=shared_spec(plan))
        found.append(known[id(plan)])
    return found


class ConfigsSharePlans:
    """A plugin: shipped configs that run as a part of the whole suite share plans."""

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Any:
        """Let the plan of a shipped config be a family's."""
        if not item.path.is_relative_to(CONFIGS) or item.path.is_relative_to(CHAPTER):
            return (yield)
        from lavendersim.runner import cell_jobs, plans

        def shared_plans(cells: Iterable[Cell]) -> list[Plan]:
            return with_shared_specs(plans.shared_plans(cells))

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(cell_jobs, "shared_plans", shared_plans)
            return (yield)
