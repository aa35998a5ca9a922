"""What a scene does not require changes no bit: engines without it and with it idle are equal.

Every effect and every shape pair is compiled into engines of scenes that do not require it, and
poses, velocities, contacts, impulses, residuals, energies and hashes are compared under ==. All are
equal: no effect needs a tolerance. What decides is that a coefficient of zero adds a zero, scales
by one or takes the same branch, and that frictionless contacts keep rows of their own.

They are compared in the interpreter, whose sums are as exact as a processor's, and all at once in
compiled code, too.

One difference is known: with `residual_log` a solver makes the sweeps that would change nothing as
well, so that `sweeps` counts more where a tolerance, or an exact solution, ends solves early.

`LAVENDER_TEST_EVERYTHING=1` takes each effect alone, and all at once, through every scene, compiled
(hours).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import pytest
from idle import MODULES, STEPS, Run, closed, compile_together, differences, may_idle
from idle_scenes import CASES, SCENES, UNLOGGED
from laboratory import planned

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import EFFECTS, impact_order
from lavendersim.engine.spec import Spec
from tests.thorough import THOROUGH

NOTHING_TOUCHES = {"flying brick"}
# Where solves end early without it.
MORE_SWEEPS = {"residual_log": ("sweeps",)}
SOME_STEPS = 84  # 0.35 s: what is thrown has landed, and what bounces has been up
HOW: dict[str, Any] = {"steps": STEPS} if THOROUGH else {"steps": SOME_STEPS, "interpreted": True}
MANY = 100 if THOROUGH else 50  # rows of contacts
# Everything at once: no effect is idle for the sake of another one that is absent.
TOGETHER = list(SCENES) if THOROUGH else ["frictional balls", "flying brick"]
# Shape pairs that do not occur in a scene.
BALLS_ALONE = ("sphere_plane", "sphere_sphere")
FOREIGN = {
    "balls": tuple(pair for pair in SHAPE_PAIRS if pair not in BALLS_ALONE),
    "boxes": BALLS_ALONE,
}


def cases() -> list[tuple[str, str]]:
    """Return the pairs of an effect and a scene that are to be compared."""
    if not THOROUGH:
        return [(name, scene) for name, scenes in CASES.items() for scene in scenes]
    return [
        (name, scene)
        for name in MODULES
        for scene in SCENES
        if may_idle(SCENES[scene](), name, record=name not in UNLOGGED)
    ]


@cache
def lean_run(scene: str, record: bool = True) -> Run:
    """Return a scene's run on its own plan, which is the same beside every effect."""
    cell = SCENES[scene]()
    return Run(cell, planned(cell, record).spec, **HOW)


Engines = tuple[dict[str, Any], Spec, Spec]  # a scene, its own plan's, and a fuller one


def with_effect(name: str, scene: str) -> Engines:
    """Return the engines without and with one effect."""
    cell = SCENES[scene]()
    lean = planned(cell, record=name not in UNLOGGED).spec
    return cell, lean, lean.including(*closed(name))


def with_all_effects(scene: str) -> Engines:
    """Return the engines without and with everything that the scene does not require."""
    cell = SCENES[scene]()
    lean = planned(cell).spec
    return cell, lean, lean.including(*all_idle(scene))


def all_idle(scene: str) -> set[str]:
    """Return what a scene does not require; Python refuses to divide by the size of a lone body."""
    cell = SCENES[scene]()
    idle = {name for name in MODULES if may_idle(cell, name)}
    return idle - {"broad_phase"} if scene in NOTHING_TOUCHES and not THOROUGH else idle


def with_shape_pairs(scene: str) -> Engines:
    """Return the engines without and with shape pairs that do not occur."""
    cell = SCENES[scene]()
    lean = planned(cell).spec
    more = {*lean.shape_pairs, *FOREIGN[scene]}
    return cell, lean, lean._replace(shape_pairs=tuple(sorted(more)))


@pytest.fixture(scope="module", autouse=True)
def compiled(request: pytest.FixtureRequest) -> None:
    """Compile what the chosen tests of this file ask for on both cores, where it is much."""
    if not THOROUGH:
        return
    chosen = [
        ENGINES[item.function](**item.callspec.params)
        for item in request.session.items
        if item.path == request.path and item.function in ENGINES
    ]
    compile_together((cell, spec) for cell, *specs in chosen for spec in specs)


def test_every_effect_has_a_scene_that_does_not_require_it() -> None:
    # An accuracy divides the steps of whatever moves: it is never idle.
    assert sorted([*CASES, "error_control"]) == sorted(effect.name for effect in EFFECTS)
    assert all(CASES.values())


@pytest.mark.parametrize(("name", "scene"), cases())
def test_an_idle_effect_changes_no_bit(name: str, scene: str) -> None:
    cell, lean, full = with_effect(name, scene)
    assert may_idle(cell, name, record=name not in UNLOGGED)
    assert not lean.has(name)
    assert full.has(name)
    one, other = lean_run(scene, name not in UNLOGGED), Run(cell, full, **HOW)
    assert one.bench.spec == lean
    assert differences(one, other, *MORE_SWEEPS.get(name, ())) == []
    if scene in CASES[name] and scene not in NOTHING_TOUCHES and name not in UNLOGGED:
        assert len(one.tables["contact"]) > MANY


def test_idle_restitution_changes_no_bit_where_impacts_spend_their_budget(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What rebounds has more of it (`impact_order`): what is compiled in does not decide."""
    monkeypatch.setattr(impact_order, "WORK", 2)
    cell, lean, full = with_effect("restitution", "plastic balls, default")
    run = {"steps": SOME_STEPS, "interpreted": True}
    one, other = Run(cell, lean, **run), Run(cell, full, **run)
    assert 0 < one.tables["step"]["unordered"].sum() < SOME_STEPS
    assert differences(one, other) == []


@pytest.mark.parametrize("scene", TOGETHER)
def test_all_idle_effects_together_change_no_bit(scene: str) -> None:
    cell, lean, full = with_all_effects(scene)
    idle = all_idle(scene)
    assert idle
    assert set(full.effects) == idle | set(lean.effects)
    assert not idle & set(lean.effects)
    assert differences(lean_run(scene), Run(cell, full, **HOW), *MORE_SWEEPS["residual_log"]) == []


def test_all_idle_effects_together_change_no_bit_of_compiled_code() -> None:
    cell, lean, full = with_all_effects("frictional balls")
    assert differences(Run(cell, lean), Run(cell, full), *MORE_SWEEPS["residual_log"]) == []


@pytest.mark.parametrize("scene", FOREIGN)
def test_shape_pairs_that_do_not_occur_change_no_bit(scene: str) -> None:
    cell, lean, full = with_shape_pairs(scene)
    assert not set(FOREIGN[scene]) & set(lean.shape_pairs)
    one, other = lean_run(scene), Run(cell, full, **HOW)
    assert differences(one, other) == []
    assert len(one.tables["contact"]) > MANY


def test_every_shape_pair_is_foreign_to_one_of_the_scenes() -> None:
    assert {pair for pairs in FOREIGN.values() for pair in pairs} == set(SHAPE_PAIRS)


ENGINES: dict[Any, Callable[..., Engines]] = {
    test_an_idle_effect_changes_no_bit: with_effect,
    test_all_idle_effects_together_change_no_bit: with_all_effects,
    test_shape_pairs_that_do_not_occur_change_no_bit: with_shape_pairs,
}
