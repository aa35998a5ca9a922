"""Every effect has a shipped config whose section `overhead` times an engine with and without it.

It is timed at work, in a scene that requires it, where one can be timed; otherwise carried idle. A
new effect has its line here, or a reason why it cannot be left out alone.
"""

from __future__ import annotations

from functools import cache

import pytest
from sources import ROOT

from lavendersim.engine.effects import EFFECTS
from lavendersim.experiment import load_experiment
from lavendersim.runner.overhead_pairs import EnginePair, pairs_of

AT_WORK = {
    "effects/carried.yaml": (
        *("drag", "kinematic", "torsional_friction", "rolling_friction", "surface_velocity"),
        "cohesion",
    ),
    "effects/anisotropic_friction.yaml": ("anisotropic_friction",),
    "effects/contact_patch.yaml": ("contact_patch",),
    "effects/hertz_contact.yaml": ("hertz_contact",),
    "effects/falling_restitution.yaml": ("falling_restitution",),
    "effects/periodic_boundary.yaml": ("periodic_boundary",),
    "effects/pile.yaml": ("broad_phase", "fast_bodies", "packed_sweeps"),
    "effects/joint.yaml": ("joint",),
    "effects/motor.yaml": ("joint_stop", "motor"),
    "effects/rope.yaml": ("rope",),
    "effects/sphere.yaml": ("frictionless_contact", "restitution"),
    "effects/prescribed_motion.yaml": ("prescribed_motion",),
    "effects/spring.yaml": ("spring",),
    "effects/stack.yaml": (
        *("gravity", "friction", "warm_start", "projection", "step_log", "contact_log"),
    ),
    "effects/static_friction.yaml": ("gyroscopic", "static_friction"),
    "effects/tangential_compliance.yaml": ("tangential_compliance",),
    "effects/tangential_restitution.yaml": ("tangential_restitution",),
    "effects/varying_force.yaml": ("varying_force",),
}
FORCES = "constant forces begin and end between steps, and interrupt the steps that are timed"
NEEDED = "friction needs it: at work it comes and goes with friction"
SWEPT = "shipped scenes that require it are sweeps; timed is a scene of one cell"
NONE = "no shipped scene requires it"
IDLE = {  # in effects/sphere.yaml, with the reason why no config has it at work
    "compound": "without it parts do not follow their body, and the scene diverges",
    "external_force": FORCES,
    "rotation": NEEDED,
    "contact_torque": NEEDED,
    "impact_order": "another law where a scene requires it; of one ball on a plane it is idle",
    "contact_spring": "another law where a scene requires it",
    "impact_energy": SWEPT,
    "stabilisation": "the default numerics, which all timed scenes have, project instead",
    "compliance": "where a scene requires it, its law needs it",
    "least_norm": "another law where a scene requires it; of one ball on a plane it is idle",
    "newton": "where a scene requires it, solves without it are another solver's",
    "anderson_acceleration": "of heaps that are given many sweeps; it is timed by large_scenes",
    "supernodes": "scenes that require it are of hundreds of boxes; it is timed by large_scenes",
    "sleeping": NONE,
    "residual_log": SWEPT,
    "problem_log": NONE,
    "triggers": "an event asks for it, of no scene that is timed",
    "velocity_log": "a key of the config asks for it, of no scene that is timed",
}
CHOSEN = "a key of the config chooses between two laws; neither is an overhead of the other"
NOT_ALONE = {
    "midpoint": CHOSEN,
    "contact_midpoint": CHOSEN,
    "impact_time": CHOSEN,
    "speculative": CHOSEN,
    "capture_in_sweeps": CHOSEN,
    "pairwise_impacts": CHOSEN,
    "error_control": "a key of the config asks for it: it is no overhead of equal timesteps",
    "overlooked_points": "it comes and goes with the impacts' order, and is timed with it",
    "sliding_stops": "it comes and goes with friction, and is timed with it",
    "pose_log": "it comes and goes with step_log, and is timed with it",
}
SCENE_OF = {name: config for config, names in AT_WORK.items() for name in names} | dict.fromkeys(
    IDLE, "effects/sphere.yaml"
)


@cache
def timed(config: str) -> dict[str, EnginePair]:
    """Return the pairs of engines that a shipped config times, by effect."""
    experiment = load_experiment(ROOT / "configs" / config)
    section = experiment.config.overhead
    assert section is not None, config
    named = () if section.effects == "all" else section.effects
    return {pair.effect: pair for pair in pairs_of(experiment.cells()[0].config, named)}


def test_every_effect_has_a_config_or_a_reason() -> None:
    listed = [*SCENE_OF, *NOT_ALONE]
    assert sorted(listed) == sorted(effect.name for effect in EFFECTS)


@pytest.mark.parametrize("name", SCENE_OF)
def test_a_config_times_the_effect_on_and_off(name: str) -> None:
    pair = timed(SCENE_OF[name])[name]
    assert pair.off is not None, pair.why_not
    assert pair.on is not None
    assert (pair.off.has(name), pair.on.has(name)) == (False, True)
    assert pair.required == (name not in IDLE)


@pytest.mark.parametrize("name", NOT_ALONE)
def test_what_cannot_be_left_out_alone_is_a_law_or_timed_with_another(name: str) -> None:
    (effect,) = (effect for effect in EFFECTS if effect.name == name)
    assert bool(effect.chosen_by) != bool(effect.overhead_with)
    assert timed("effects/sphere.yaml")[name].why_not
