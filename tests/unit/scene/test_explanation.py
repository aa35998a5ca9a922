"""What a plan is said to bring is what its modules state and what its engine is composed of."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import EFFECTS
from lavendersim.engine.record_layout import allocate_bodies, allocate_pairs, allocate_velocities
from lavendersim.engine.solvers.catalogue import SOLVERS
from lavendersim.engine.spec import Spec
from lavendersim.engine.step import kernels_of
from lavendersim.experiment import load_experiment
from lavendersim.scene.explanation import Explanation, composed_kernels, explain
from lavendersim.scene.plan import Plan, plan_of_cell

CONFIGS = Path(__file__).parents[3] / "configs"
NAMES = ("scenes/stack_of_six", "scenes/drop", "chapter/warm_start", "scenes/frictional_rod")
# Records whose columns an effect lists, whatever else an engine has.
RECORDS = ("body", "velocity", "pair", "cache", "contact_row")


def plan(name: str) -> Plan:
    return plan_of_cell(load_experiment(CONFIGS / f"{name}.yaml").cells()[0])


@pytest.fixture(scope="module", params=NAMES)
def explained(request: pytest.FixtureRequest) -> tuple[Plan, Explanation]:
    one = plan(request.param)
    return one, explain(one)


def test_every_effect_and_pair_is_there_in_the_engines_order(
    explained: tuple[Plan, Explanation],
) -> None:
    _, said = explained
    assert [part.name for part in said.effects] == [effect.name for effect in EFFECTS]
    assert [part.name for part in said.shape_pairs] == list(SHAPE_PAIRS)
    assert said.solver.name in SOLVERS


def test_what_is_on_is_the_spec(explained: tuple[Plan, Explanation]) -> None:
    one, said = explained
    assert tuple(sorted(p.name for p in said.effects if p.on)) == one.spec.effects
    assert tuple(sorted(p.name for p in said.shape_pairs if p.on)) == one.spec.shape_pairs
    assert (said.digest, Spec(**said.spec)) == (one.spec.digest(), one.spec)


def test_fields_and_channels_are_those_of_the_modules(explained: tuple[Plan, Explanation]) -> None:
    _, said = explained
    for effect, part in zip(EFFECTS, said.effects, strict=True):
        declared = effect.columns_by_record()
        for record in RECORDS:
            assert part.fields.get(record, []) == declared.get(record, []), (part.name, record)
        assert set(declared.get("contact", [])) <= set(part.fields.get("contact", []))
        assert set(declared.get("step_row", [])) <= set(part.fields.get("step_row", []))
        assert part.channels == list(effect.channels or ())
        assert part.needs == list(effect.needs)


@pytest.mark.parametrize(
    ("record", "allocate"),
    [("body", allocate_bodies), ("velocity", allocate_velocities), ("pair", allocate_pairs)],
)
def test_arrays_have_the_columns_that_are_said(
    explained: tuple[Plan, Explanation], record: str, allocate: Any
) -> None:
    """Beside what an engine without effects has: the difference of the allocated dtypes."""
    one, said = explained
    columns = set(allocate(one.spec, 1).dtype.names)
    base = set(allocate(one.spec.without(*one.spec.effects), 1).dtype.names)
    brought = {name for part in said.parts() if part.on for name in part.fields.get(record, [])}
    assert columns == base | brought


def test_every_composed_kernel_is_listed(explained: tuple[Plan, Explanation]) -> None:
    one, said = explained
    groups = [said.always, said.shared, *(part.kernels for part in said.parts())]
    listed = {
        (module, name) for group in groups for module, names in group.items() for name in names
    }
    composed = composed_kernels(one.spec)
    assert listed == {(module, name) for module, names in composed.items() for name in names}
    assert {"step", "contact", "solvers.sweep"} <= set(composed)


def test_what_is_off_brings_no_kernel(explained: tuple[Plan, Explanation]) -> None:
    _, said = explained
    assert all(part.kernels == {} for part in said.parts() if not part.on)
    own = {f"effects.{effect.name}": effect.name for effect in EFFECTS}
    for part in said.parts():
        assert {own[m] for m in part.kernels if m.startswith("effects.")} <= {part.name}


def test_an_effect_brings_the_kernels_that_vanish_without_it() -> None:
    one = plan("scenes/drop")
    brought = {part.name: part.kernels for part in explain(one).effects}["warm_start"]
    lean = kernels_of(one.spec.without("warm_start"))
    assert brought
    for module, names in brought.items():
        assert not set(names) & set(lean.get(module, ()))


def test_it_is_plain_data(explained: tuple[Plan, Explanation]) -> None:
    one, said = explained
    data = json.loads(json.dumps(said.as_data()))
    for name, decision in one.decisions.items():
        assert data["effects"][name]["on"] is decision.on
        assert data["effects"][name]["reason"] == decision.reason
        assert data["effects"][name]["reasons"] == {decision.reason: [0]}
    assert set(data["shape_pairs"]) == set(SHAPE_PAIRS)
