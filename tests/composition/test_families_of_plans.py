"""Families of plans add to a scene's own plan what is idle there, and never what chooses a law."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from lavendersim.experiment import load_experiment
from lavendersim.pytest_plugin import _is_experiment
from lavendersim.runner.plans import distinct, shared_plans
from lavendersim.scene.plan import Plan
from tests.families_of_plans import CONFIGS, NEVER_ADDED, spec_of_family, with_specs_of_families


def shipped() -> Iterator[Plan]:
    """Yield every plan that a shipped config has by itself."""
    for file in sorted(CONFIGS.rglob("*.yaml")):
        if _is_experiment(file):
            yield from distinct(shared_plans(load_experiment(file, True).cells()))


@pytest.fixture(scope="module")
def plans() -> list[Plan]:
    found = list(shipped())
    assert len(found) > 100
    return found


def test_a_family_has_all_that_a_scene_requires_and_its_laws(plans: list[Plan]) -> None:
    for plan in plans:
        shared = spec_of_family(plan)
        assert {*plan.spec.effects} <= {*shared.effects}
        assert {*plan.spec.shape_pairs} <= {*shared.shape_pairs}
        assert shared[2:] == plan.spec[2:]  # solver, cone, order of sweeps
        assert not NEVER_ADDED & ({*shared.effects} - {*plan.spec.effects})


def test_shipped_configs_have_few_plans_with_families(plans: list[Plan]) -> None:
    """What they are for: of 119 plans some 70 are not compiled."""
    assert len({spec_of_family(plan) for plan in plans}) < 0.5 * len({plan.spec for plan in plans})


def test_cells_of_one_plan_stay_cells_of_one_plan(plans: list[Plan]) -> None:
    one, other = plans[:2]
    first, again, second = with_specs_of_families([one, one, other])
    assert first is again
    assert first is not second
    assert (first.choices, first.decisions) == (one.choices, one.decisions)
