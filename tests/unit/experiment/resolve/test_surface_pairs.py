"""What is written of two surfaces holds where they touch; what is not follows from the two."""

from __future__ import annotations

import json
from collections import Counter
from math import sqrt

import pytest

from lavendersim.cell import CellConfig, PairedSurface, Surface
from lavendersim.cell.mixing import mixed
from lavendersim.engine.effects import SURFACE_KEYS
from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.candidates import candidate_pairs
from lavendersim.scene.classes import class_pairs
from lavendersim.scene.colliders import colliders
from lavendersim.scene.plan import plan_of_cell

SCENE = """\
scene:
  surfaces:
    steel: {friction: 0.9, restitution: 0.2, compliance: 1e-6}
    ice: {friction: 0.1, restitution: 0.7, compliance: 2e-6}
    wood: {friction: 0.4}
  surface_pairs:
    slippery: {between: [steel, ice], friction: 0.02, restitution: 0}
    alike: {between: [steel, steel], friction: 1.1}
  bodies:
    floor: {shape: {kind: plane}, surface: ice}
    steel_a: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1], surface: steel}
    steel_b: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [2, 0, 1], surface: steel}
    wood: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [4, 0, 1], surface: wood}
    twin:
      shape: {kind: sphere, radius: 0.1}
      mass: 1
      position: [6, 0, 1]
      surface: {friction: 0.9, restitution: 0.2, compliance: 1e-6}
duration: 1
"""


def cell(text: str = SCENE) -> CellConfig:
    return load_experiment_text(text, "t.yaml").cells()[0].config


def between(one: str, other: str, text: str = SCENE) -> Surface:
    bodies = cell(text).scene.bodies
    pair = mixed(bodies[one].surface, bodies[other].surface)
    assert pair == mixed(bodies[other].surface, bodies[one].surface)
    return pair


def test_what_is_written_of_two_surfaces_takes_the_place_of_what_they_mix_to() -> None:
    pair = between("steel_a", "floor")
    assert (pair.friction, pair.restitution) == (0.02, 0.0)
    assert pair.compliance == 1e-6 + 2e-6  # nothing is written of it


def test_the_order_of_the_two_names_says_nothing() -> None:
    turned = SCENE.replace("[steel, ice]", "[ice, steel]")
    assert between("steel_a", "floor", turned) == between("steel_a", "floor")


def test_two_of_one_surface_are_a_pair_too() -> None:
    assert between("steel_a", "steel_b").friction == 1.1
    assert between("steel_a", "steel_b").restitution == 0.2


@pytest.mark.parametrize("name", ["wood", "twin"])
def test_others_mix(name: str) -> None:
    """Wood stands in no pair; twin's surface is equal to steel, and has no name."""
    own = {"wood": 0.4, "twin": 0.9}[name]
    # The square root of a product: two roundings.
    assert between(name, "floor").friction == pytest.approx(sqrt(own * 0.1), rel=2 * 1.1e-16)
    assert between(name, "steel_a").friction == pytest.approx(sqrt(own * 0.9), rel=2 * 1.1e-16)


GRAIN = "across_grain"  # needs a body with a grain, beside which nothing may roll
STIFF = ["hertz_stiffness", "hunt_crossley_dissipation"]  # a law beside which no compliance stands
# Beside these there is no static friction.
YIELDING = ["tangential_stiffness", "tangential_damping_ratio"]
APART = (GRAIN, *STIFF, *YIELDING)
TOGETHER = [key.name for key in SURFACE_KEYS if key.name not in APART]


@pytest.mark.parametrize("names", [TOGETHER, ["friction", GRAIN], STIFF, ["friction", *YIELDING]])
def test_every_property_can_be_written_of_a_pair(names: list[str]) -> None:
    written = dict.fromkeys(names, 0.125)
    line = json.dumps({"between": ["steel", "ice"], **written}).replace('"', "")
    text = SCENE.replace("{between: [steel, ice], friction: 0.02, restitution: 0}", line)
    if GRAIN in names:
        text = text.replace("surface: wood}", "surface: wood, grain: [1, 0, 0]}")
    if STIFF[0] in names:
        for compliance in (", compliance: 1e-6", ", compliance: 2e-6"):
            text = text.replace(compliance, "")
    pair = between("steel_a", "floor", text)
    assert {name: getattr(pair, name) for name in names} == written


def test_a_cell_without_pairs_is_what_it_was() -> None:
    """Equal digests, so equal logs: neither names nor partners of surfaces are in it."""
    head, _, tail = SCENE.partition("  surface_pairs:")
    bare = cell(head + "  bodies:" + tail.partition("  bodies:")[2])
    assert {type(body.surface) for body in bare.scene.bodies.values()} == {Surface}
    assert "partners" not in bare.as_json()


def test_only_surfaces_that_stand_in_a_pair_have_partners() -> None:
    bodies = cell().scene.bodies
    paired = {name for name, body in bodies.items() if isinstance(body.surface, PairedSurface)}
    assert paired == {"floor", "steel_a", "steel_b"}


def test_a_cell_with_pairs_comes_back_from_its_text() -> None:
    config = cell()
    assert CellConfig.from_dict(json.loads(config.as_json())) == config


def test_what_is_not_written_of_a_pair_is_not_in_the_text_of_a_cell() -> None:
    surface = cell().as_dict()["scene"]["bodies"]["floor"]["surface"]
    assert surface["partners"] == [{"restitution": 0.0, "friction": 0.02, "surface": "steel"}]


def test_pairs_of_classes_hold_what_the_list_of_all_pairs_holds() -> None:
    bodies = list(cell().scene.bodies.values())
    listed = Counter((pair.shape_pair, pair.surface) for pair in candidate_pairs(bodies))
    counted: Counter = Counter()
    for pair in class_pairs(colliders(bodies)):
        counted[pair.shape_pair, pair.surface] += pair.row_pairs
    assert counted == listed


def test_the_plan_gives_the_value_of_the_pair_for_its_reason() -> None:
    (one,) = load_experiment_text(SCENE, "t.yaml").cells()
    decisions = plan_of_cell(one).decisions
    assert decisions["friction"].reason.startswith("floor and steel_a: sliding 0.02; ")
    # floor and steel_a give back 0, though both surfaces have restitution
    assert "floor and steel_a: none" in decisions["restitution"].reason


def test_friction_of_a_pair_alone_is_an_effect() -> None:
    text = SCENE.replace("friction: 0.9, ", "").replace("friction: 0.1, ", "")
    text = text.replace("friction: 0.4", "").replace(", friction: 1.1", ", cohesion: 0.1")
    (one,) = load_experiment_text(text, "t.yaml").cells()
    reason = plan_of_cell(one).decisions["friction"].reason
    assert reason.startswith("floor and steel_a: sliding 0.02; ")


def test_a_coefficient_of_a_pair_is_swept_by_its_name() -> None:
    path = "scene.surface_pairs.slippery.friction"
    text = SCENE + f"sweep: {{mu: {{path: {path}, values: [0.1, 0.3]}}}}\n"
    found = []
    for one in load_experiment_text(text, "t.yaml").cells():
        bodies = one.config.scene.bodies
        found.append(mixed(bodies["floor"].surface, bodies["steel_a"].surface).friction)
    assert found == [0.1, 0.3]


def test_a_body_whose_surface_is_swept_by_name_takes_the_pairs_of_each() -> None:
    sweep = "sweep: {s: {path: scene.bodies.wood.surface, values: [wood, steel]}}\n"
    found = []
    for one in load_experiment_text(SCENE + sweep, "t.yaml").cells():
        bodies = one.config.scene.bodies
        found.append(mixed(bodies["floor"].surface, bodies["wood"].surface).friction)
    assert found == [pytest.approx(0.2, rel=2 * 1.1e-16), 0.02]


def test_a_value_set_inside_a_named_surface_of_a_pair_is_refused() -> None:
    """A copy of steel for one body would have no name, and so leave the pair without a word."""
    override = ("set scene.bodies.steel_a.surface.friction=0.5",)
    with pytest.raises(ConfigError, match=r"expected scene\.surfaces\.steel\.friction or"):
        load_experiment_text(SCENE, "t.yaml", overrides=override)
    other = ("set scene.bodies.wood.surface.friction=0.5",)
    load_experiment_text(SCENE, "t.yaml", overrides=other)
