"""Random configs break no law, on the engine with everything and on a drawn one.

So does what was found once, on the engine with everything where that has all of its own: the rest
is idle there and changes no bit (tests/composition), and one engine is compiled.

`LAVENDER_TEST_FUZZ` draws more than 100 configs; `tests/property/fuzz.py` draws them on more plans.
Of the first 24 on the engine with everything the 22nd takes a minute of the processor, and all
others together half of one: every night twelve times as many are drawn.
"""

from __future__ import annotations

import os
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fuzz import HEADING, Kept, drawn, drawn_plans, finds, first_config, fuzz, summarised
from fuzz_laws import broken, loaded, run, text_of
from fuzz_scenes import ACCURATE, EVERY, FORCED, FULL, JOINED, NOT_DRAWN, SOLIDS, Drawn, found_once
from idle import compile_together

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import EFFECTS
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.plan import plan_of_cell
from tests.families_of_plans import spec_of_family

CONFIGS = int(os.environ.get("LAVENDER_TEST_FUZZ", "100"))
ENGINES = {"everything": FULL, **{f"drawn {k}": plan for k, plan in enumerate(drawn_plans(1))}}
FOUND = {name: tree for name, tree in found_once().items() if FULL.has_all_of(tree)}
SHARE = {"everything": 2, "drawn 0": 8}  # tenths of the configs: the first are dear


@pytest.fixture(scope="module", autouse=True)
def compiled(optimised: None) -> None:
    """Compile the engines on both cores."""
    engines = []
    for plan in ENGINES.values():
        experiment, spec = loaded(first_config(plan))
        engines.append((experiment.cells()[0].config.as_dict(), spec))
    compile_together(engines)


@pytest.mark.parametrize("name", ENGINES)
def test_random_configs_break_no_law(name: str) -> None:
    assert [find.laws for find in finds(ENGINES[name], CONFIGS * SHARE[name] // 10)] == []


@pytest.mark.parametrize("tree", FOUND.values(), ids=FOUND)
def test_what_was_found_once_breaks_no_law_beside_everything(tree: dict[str, Any]) -> None:
    shared = loaded(first_config(FULL))[1]
    assert broken(tree | {"effects": FULL.switches()}, shared) == []


def test_the_fullest_engine_has_every_effect_and_pair_of_shapes() -> None:
    spec = loaded(first_config(FULL))[1]
    assert {*spec.effects} == EVERY
    assert {*spec.shape_pairs} == {*SHAPE_PAIRS}
    assert FULL.shapes == SOLIDS


def test_shipped_finds_have_the_fullest_engine_where_the_suite_runs_them() -> None:
    for tree in FOUND.values():
        (cell,) = load_experiment_text(text_of(tree), "found.yaml").cells()
        assert spec_of_family(plan_of_cell(cell)) == loaded(first_config(FULL))[1]


def test_drawn_engines_differ_in_what_they_leave_out() -> None:
    plans: list[Drawn] = drawn_plans(20)
    assert len({repr(plan) for plan in plans}) == 20
    assert len({plan.numerics["solver"] for plan in plans}) >= 5
    assert all(set(plan.effects) < set(FULL.effects) for plan in plans)


def test_every_effect_is_drawn_or_said_not_to_be() -> None:
    """An effect is drawn where some scene requires it, whatever is forced on."""
    required: set[str] = set()
    for plan in (FULL, JOINED, ACCURATE, *drawn_plans(8)):
        for number in range(100 if plan in (FULL, JOINED) else 10):
            tree = drawn(plan, "drawn", 0, number) | {"effects": {}}
            required |= {*loaded(tree)[1].effects}
    assert not required & {*NOT_DRAWN, *FORCED}
    assert required | {*NOT_DRAWN, *FORCED} == {effect.name for effect in EFFECTS}
    assert {*FORCED} <= {*FULL.effects}


def test_each_run_of_the_accurate_engine_asks_for_an_accuracy() -> None:
    trees = [drawn(ACCURATE, "accurate", 0, number) for number in range(20)]
    engines = {loaded(tree)[1] for tree in trees}
    assert len(engines) == 1
    assert engines.pop().has("error_control")
    for tree in trees:
        numerics = tree["numerics"]
        assert 0.0 < numerics["accuracy"] < 1.0
        assert numerics["smallest_timestep"] <= float(Fraction(numerics["timestep"])) / 8.0


def test_a_cavity_or_a_ground_changes_no_draw_of_other_bodies(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """So a scene without one is what it was before there were any."""
    trees = [drawn(FULL, "full", 0, number)["scene"]["bodies"] for number in range(40)]
    monkeypatch.setattr("fuzz_scenes.cavity", lambda *_: None)
    monkeypatch.setattr("fuzz_scenes.ground", lambda *_: None)
    plain = [drawn(FULL, "full", 0, number)["scene"]["bodies"] for number in range(40)]
    assert any("cavity" in bodies for bodies in trees)
    assert any("ground" in bodies for bodies in trees)
    for bodies, alone in zip(trees, plain, strict=True):
        around = {"cavity", "ground"} & {*bodies}
        if not around:
            assert bodies == alone
        else:
            shapes = {name: one["shape"] for name, one in bodies.items() if name not in around}
            assert shapes == {name: body["shape"] for name, body in alone.items()}


def test_a_run_is_drawn_from_its_number_alone() -> None:
    first = [drawn(FULL, "full", 3, number) for number in range(5)]
    assert [drawn(FULL, "full", 3, number) for number in (4, 3)] == [first[4], first[3]]
    assert len({repr(tree) for tree in first}) == 5


def _fall() -> dict[str, Any]:
    """Return a ball that rolls into a wall, on the engine with everything."""
    tree = first_config(FULL)
    ball = {"shape": {"kind": "sphere", "radius": 0.1}, "mass": 1.0, "position": [0.0, 0.0, 0.1],
            "velocity": [1.0, 0.0, 0.0], "surface": {"friction": 0.5}}  # fmt: skip
    floor = {"shape": {"kind": "plane"}, "surface": {"friction": 0.5}}
    tree["scene"] = {"gravity": [0.0, 0.0, -9.81], "bodies": {"ball": ball, "floor": floor}}
    tree["numerics"]["timestep"] = "1/240"
    return {**tree, "events": [], "duration": 0.1}


BREAKS = {  # a change of a log, and the law that it breaks
    "push": lambda rows: rows.contact["impulse_n"].__imul__(-1.0),
    "cone": lambda rows: rows.contact["impulse_t1"].__iadd__(1.0),
    "counts": lambda rows: rows.step["contact_count"].__iadd__(1),
    "unit": lambda rows: rows.contact["nz"].__imul__(1.1),
    "finite": lambda rows: rows.step["kinetic_energy"].fill(np.nan),
    "momentum": lambda rows: rows.contact["impulse_n"].__imul__(1.001),
    "penetration": lambda rows: rows.step["max_penetration"][2:].__iadd__(1.0),
    "equal runs": lambda rows: rows.pose.__imul__(1.0 + 1e-15),
}


def test_a_step_that_fills_the_log_is_judged_from_where_it_began() -> None:
    """A ball flies 10/30 m between walls that leave it a millimetre: 333 impacts, 32 rows."""
    tree = _fall()
    ball = tree["scene"]["bodies"]["ball"]
    ball |= {"position": [0.0, 0.0, 0.1005], "velocity": [0.0, 0.0, 10.0]}
    ball["surface"] = {"restitution": 1.0}
    ceiling = {"shape": {"kind": "plane", "normal": [0.0, 0.0, -1.0], "offset": -0.201}}
    tree["scene"]["bodies"]["ceiling"] = ceiling
    tree["numerics"]["timestep"] = "1/30"
    assert broken(tree) == []
    experiment, spec = loaded(tree)
    ended = run(experiment.cells()[0].config, spec, 3, by_step=True)
    begun = np.stack([velocities["vz"] for (_, velocities, _), _ in ended.states])
    assert np.array_equal(begun, ended.rows.pose[:-1, :, 9])
    assert (ended.rows.step["parts"][1:] > 300).all()


@pytest.mark.parametrize("law", BREAKS)
def test_each_law_bites(law: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def bent(*arguments: Any, **named: Any) -> Any:
        ended = run(*arguments, **named)
        if named or law != "equal runs":
            BREAKS[law](ended.rows)
        return ended

    assert broken(_fall()) == []
    monkeypatch.setattr("fuzz_laws.run", bent)
    assert law in {said.split(":")[0] for said in broken(_fall())}


def test_a_push_across_a_gap_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    def bent(*arguments: Any, **named: Any) -> Any:
        ended = run(*arguments, **named)
        ended.rows.contact["separation"] += 1.0
        return ended

    assert broken(_fall()) == []
    monkeypatch.setattr("fuzz_laws.run", bent)
    assert "gap" in {said.split(":")[0] for said in broken(_fall())}


def test_friction_beyond_its_ellipse_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    tree = _fall()
    ball = tree["scene"]["bodies"]["ball"]
    ball["grain"], ball["surface"] = [1.0, 1.0, 0.0], {"friction": 0.5, "across_grain": 0.5}

    def bent(*arguments: Any, **named: Any) -> Any:
        ended = run(*arguments, **named)
        ended.rows.contact["friction_11"] *= 0.9
        ended.rows.contact["friction_22"] *= 0.9
        return ended

    assert broken(tree) == []
    monkeypatch.setattr("fuzz_laws.run", bent)
    assert "cone" in {said.split(":")[0] for said in broken(tree)}


def test_runs_go_on_behind_those_that_are_finished(tmp_path: Path) -> None:
    kept = Kept(tmp_path, "plan", 0)
    (tmp_path / "finished.csv").write_text(",".join(HEADING) + "\n")
    fuzz(kept, ENGINES["drawn 0"], 3)
    assert kept.next() == 3
    fuzz(kept, ENGINES["drawn 0"], 5)
    assert [(row["first"], row["runs"]) for row in kept.finished()] == [("0", "3"), ("3", "2")]
    assert summarised(tmp_path) == 0


def test_what_is_removed_neither_moves_nor_touches(monkeypatch: pytest.MonkeyPatch) -> None:
    tree = _fall() | {"events": [{"at": 0.05, "body": "ball", "remove": True}]}

    def bent(*arguments: Any, **named: Any) -> Any:
        ended = run(*arguments, **named)
        ended.rows.pose[20:, 0] += 1.0
        return ended

    assert broken(tree) == []
    monkeypatch.setattr("fuzz_laws.run", bent)
    assert "immovable: ball is removed, and moved" in broken(tree)


def test_what_is_kinematic_keeps_its_velocity(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where the run ends with a state that is no number: what is kinematic is fixed, too."""
    tree = _fall()
    tree["scene"]["bodies"]["lift"] = {
        "shape": {"kind": "sphere", "radius": 0.1}, "position": [9.0, 0.0, 0.5], "kinematic": True,
        "velocity": [0.0, 0.0, 1.0], "angular_velocity": [0.0, 0.5, 0.0],
    }  # fmt: skip
    assert broken(tree) == []

    def bent(*arguments: Any, **named: Any) -> Any:
        ended = run(*arguments, **named)
        ended.rows.pose[3, 2, 11] += 1e-9
        return ended

    with monkeypatch.context() as patch:
        patch.setattr("fuzz_laws.run", bent)
        assert "immovable: lift is kinematic, and its velocity changed" in broken(tree)
    tree["scene"]["bodies"]["ball"]["mass"] = 1e-3
    push = {"body": "ball", "from": 0.05, "to": 0.1, "force": [1e307, 0.0, 0.0]}
    tree["scene"]["forces"] = [push | {"torque": [0.0, 0.0, 0.0]}]
    assert broken(tree) == []
    experiment, spec = loaded(tree)
    assert run(experiment.cells()[0].config, spec, 24).said


def test_a_mass_that_stands_as_a_number_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """A force, pushing at both ends of the unit, that is not proportional to mass."""
    tree = _fall()
    push = {"body": "ball", "from": 0.0, "to": 0.1, "force": [1.0, 0.0, 0.0]}
    tree["scene"]["forces"] = [push | {"torque": [0.0, 0.0, 0.0]}]
    assert broken(tree) == []
    monkeypatch.setattr("fuzz_units.WITH", ("mass",))
    assert [said.split(":")[0] for said in broken(tree)] == ["units"]


def test_scenes_have_all_that_drives_them() -> None:
    """Of four hundred configs each has some of what the fuzz draws beside bodies."""
    trees = [drawn(FULL, "full", 0, number) for number in range(400)]
    events = {key for tree in trees for event in tree["events"] for key in event}
    assert {"timestep", "remove", "when", "gravity", "surface", "orientation"} <= events
    scenes = [tree["scene"] for tree in trees]
    assert any("surface_pairs" in scene for scene in scenes)
    assert any(scene["springs"] for scene in scenes)
    assert any(scene["connections"] for scene in scenes)
    assert any("factor" in force for scene in scenes for force in scene["forces"])
    bodies = [body for scene in scenes for body in scene["bodies"].values()]
    assert any("motion" in body for body in bodies)
    surfaces = [body["surface"] for body in bodies if isinstance(body["surface"], dict)]
    keys = {key for surface in surfaces for key in surface}
    assert keys >= {"static_friction", "cohesion", "yield_speed", "damping_ratio", "compliance"}
    around = [scene["bodies"]["cavity"] for scene in scenes if "cavity" in scene["bodies"]]
    assert 40 < len(around) < 100  # one of six
    assert {body["shape"]["kind"] for body in around} == {"bowl", "drum"}
    assert any("motion" in body for body in around)
    assert any(body.get("angular_velocity") for body in around)
    grounds = [scene["bodies"]["ground"] for scene in scenes if "ground" in scene["bodies"]]
    assert 20 < len(grounds) < 70  # one of eight, of those without a cavity
    assert {body["shape"]["kind"] for body in grounds} == {"height_field", "mesh"}
    masses = [body["mass"] for body in bodies if "mass" in body]
    assert max(masses) / min(masses) > 1e9


def test_a_state_that_is_no_number_is_reported_as_a_divergence() -> None:
    tree = _fall()
    tree["scene"]["bodies"]["ball"]["velocity"] = [1e200, 0.0, 0.0]
    assert broken(tree) == []
    experiment, spec = loaded(tree)
    ended = run(experiment.cells()[0].config, spec, 24)
    assert ended.said.startswith("diverged: body ball is no longer finite after step 1")
