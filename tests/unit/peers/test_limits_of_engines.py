"""What an engine cannot do is refused where the file has it."""

from __future__ import annotations

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

CONFIG = """\
engine: mujoco
scene:
  surfaces: {rubber: {friction: 0.5}}
  bodies:
    floor: {shape: {kind: plane}, surface: rubber}
    ball: {shape: {kind: sphere, radius: 1}, mass: 1, position: [0, 0, 1], surface: rubber}
duration: 1
"""
CASES = [
    ("friction: 0.5", "friction: 0.5, cohesion: 2", "3:38: cohesion: MuJoCo does not obey it"),
    ("mass: 1", "mass: 1, drag: {linear: 1}", "6:55: drag: MuJoCo has none here"),
    ("mass: 1", "kinematic: true", "6:46: kinematic: MuJoCo has none here"),
    (
        "duration: 1",
        "duration: 1\nevents: [{at: 0.5, body: ball, scale_mass: 2}]",
        "8:1: events: MuJoCo takes no events",
    ),
    (
        "duration: 1",
        "duration: 1\nevents: [{when: {body: ball, below: 0}, body: ball, remove: true}]",
        "8:1: events: MuJoCo takes no events",
    ),
    (
        "duration: 1",
        "duration: 1\nnumerics: {accuracy: 1e-4}",
        "8:12: accuracy: MuJoCo makes every step one timestep long",
    ),
    (
        "duration: 1",
        "duration: 1\nrecord: {residuals: all}",
        "8:10: residuals: MuJoCo reports no residuals",
    ),
    ("duration: 1", "duration: 1\neffects: {friction: on}", "8:1: effects: MuJoCo has none"),
    ("engine: mujoco\n", "engine: bulet\n", '1:9: engine: no engine is called "bulet"'),
    (
        "engine: mujoco\n",
        "engine: mujoco\nengines: {mujoco: {iteration: 3}}\n",
        '2:20: unknown key "iteration" in engines.mujoco; did you mean "iterations"?',
    ),
    (
        "engine: mujoco\n",
        "engine: mujoco\nengines: {mujoco: {cone: eliptic}}\n",
        '2:26: cone: expected pyramidal or elliptic, found the text "eliptic"',
    ),
]


@pytest.mark.parametrize(("before", "after", "said"), CASES)
def test_a_key_is_refused_at_its_place(before: str, after: str, said: str) -> None:
    with pytest.raises(ConfigError) as refused:
        load_experiment_text(CONFIG.replace(before, after), "c.yaml")
    assert any(str(one).startswith(f"c.yaml:{said}") for one in refused.value.defects), (
        refused.value
    )


@pytest.mark.parametrize(("before", "after", "said"), CASES[:7])
def test_lavender_does_what_is_refused_there(before: str, after: str, said: str) -> None:
    text = CONFIG.replace(before, after).replace("engine: mujoco\n", "")
    assert load_experiment_text(text, "c.yaml").cells()[0].config.engine is None


def test_a_swept_engine_is_refused_by_its_own_cell() -> None:
    text = CONFIG.replace("engine: mujoco\n", "").replace("0.5}", "0.5, cohesion: 2}")
    text += "sweep: {engine: {path: engine, values: [lavender, mujoco]}}\n"
    with pytest.raises(ConfigError, match=r"c\.yaml:2:38: cohesion: MuJoCo does not obey it"):
        load_experiment_text(text, "c.yaml")


def test_settings_of_the_file_take_the_place_of_those_of_the_variant() -> None:
    text = CONFIG.replace(
        "engine: mujoco\n", "engine: mujoco-stiff\nengines: {mujoco: {tolerance: 1e-6}}\n"
    )
    engine = load_experiment_text(text, "c.yaml").cells()[0].config.engine
    assert engine is not None
    assert engine.name == "mujoco-stiff"
    assert engine.settings["tolerance"] == 1e-6
    assert engine.settings["cone"] == "elliptic"


def test_a_cell_without_another_engine_has_the_data_that_it_had() -> None:
    config = load_experiment_text(
        CONFIG.replace("engine: mujoco", "engine: lavender"), "c"
    ).cells()[0]
    assert "engine" not in config.config.as_dict()
    assert '"engine"' not in config.config.as_json()
    other = load_experiment_text(CONFIG, "c").cells()[0].config
    assert type(other).from_dict(other.as_dict()) == other
    assert other.record.velocities


MIXED = """\
engine: {engine}
scene:
  surfaces: {{ice: {{friction: 0.1, restitution: 0.5}}, rubber: {{friction: 0.9}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: ice}}
    a: {{shape: {{kind: sphere, radius: 1}}, mass: 1, position: [0, 0, 1], surface: rubber}}
    b: {{shape: {{kind: sphere, radius: 1}}, mass: 1, position: [4, 0, 1], surface: rubber}}
duration: 1
"""
NO_PRODUCT = (
    "takes the product of two bodies, and no values of bodies were found that give 0.5 between "
    "floor and a"
)


@pytest.mark.parametrize(
    ("engine", "said"),
    [
        # Balls meet each other at 0.9 and the floor at sqrt(0.1 0.9): a mean asks -0.3 of it.
        # They give each other nothing back and half on the floor, which no product of a 0 is: that
        # of the floor's surface is named, as theirs has none.
        (
            "physx-pgs",
            "3:63: friction: PhysX takes the mean of two bodies, and no values of bodies "
            "were found that give 0.3 between floor and a",
        ),
        ("bullet", f"3:35: restitution: Bullet {NO_PRODUCT}"),
        ("dart", f"3:35: restitution: DART {NO_PRODUCT}"),
    ],
)
def test_surfaces_that_its_rule_cannot_mix_are_refused_where_they_stand(
    engine: str, said: str
) -> None:
    with pytest.raises(ConfigError) as refused:
        load_experiment_text(MIXED.format(engine=engine), "c.yaml")
    assert any(str(one).startswith(f"c.yaml:{said}") for one in refused.value.defects), (
        refused.value
    )


@pytest.mark.parametrize("engine", ["lavender", "mujoco", "rapier-stiff"])
def test_an_engine_that_mixes_them_has_them(engine: str) -> None:
    """Rapier multiplies roots of friction and takes the larger restitution; MuJoCo has pairs."""
    assert load_experiment_text(MIXED.format(engine=engine), "c.yaml").cells()
