"""Effects switched by hand: what is idle comes in with what it needs, what is required stays."""

from __future__ import annotations

import pytest

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import EFFECTS
from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.laws import choice, needs
from lavendersim.scene.plan import Plan, plan_of_cell

SCENE = """\
scene:
  bodies:
    floor: {{shape: {{kind: plane}}, surface: {{friction: {mu}}}}}
    ball:
      shape: {{kind: sphere, radius: 0.1}}
      mass: 1.0
      surface: {{restitution: {e}, friction: {mu}}}
      release: {{above: floor, clearance: 0.05}}
numerics: {numerics}
duration: 0.1
"""
BY_NAME = {effect.name: effect for effect in EFFECTS}
# Effect -> the first value of its key that has it, and the first that has it not.
LAWS = {
    "impact_time": ("at_surface", "captured"),
    "impact_order": ("in_order", "captured"),
    "pairwise_impacts": ("pairwise", "together"),
    "midpoint": ("midpoint", "semi_implicit_euler"),
    "contact_midpoint": ("midpoint_contact", "semi_implicit_euler"),
    "contact_spring": ("spring", "regularised"),
    "error_control": ("0.001", "null"),
    "speculative": ("true", "false"),
    "newton": ("adaptive", "projected_gauss_seidel"),
    "least_norm": ("least_norm", "as_solved"),
}
# One ball and one plane need no order of impacts.
SOFT = "surface: {compliance: 1e-4, "  # nor does what is rigid need a law of compliance
ANOTHER = "    other: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [9, 0, 9]}\n"
LAWFUL = [effect.name for effect in EFFECTS if effect.chosen_by]
MISTAKE = "capture_in_sweeps"  # chosen by the study; all others by the numerics
CHOSEN = [name for name in LAWFUL if name != MISTAKE]
# Those of which something needs a law are refused with it, see below.
IDLE = [
    name
    for name in (*BY_NAME, *SHAPE_PAIRS)
    if not {name, *(BY_NAME[name].needs if name in BY_NAME else ())} & set(LAWFUL)
]


def config(effects: str = "", mu: float = 0.0, e: float = 0.5, numerics: str = "chapter") -> str:
    section = f"effects: {{{effects}}}\n" if effects else ""
    return SCENE.format(mu=mu, e=e, numerics=numerics) + section


def planned(text: str) -> Plan:
    (cell,) = load_experiment_text(text, "t.yaml").cells()
    return plan_of_cell(cell)


def refused(text: str) -> list[str]:
    with pytest.raises(ConfigError) as caught:
        planned(text)
    assert caught.value.exit_code == 2
    return str(caught.value).splitlines()


def where(text: str, key: str) -> str:
    """The place of a key of `effects` as an editor counts it."""
    lines = text.splitlines()
    column = lines[-1].index(f"{key}:") + 1
    return f"t.yaml:{len(lines)}:{column}"


@pytest.mark.parametrize("name", IDLE)
def test_whatever_is_no_law_can_be_switched_on(name: str) -> None:
    derived = planned(config())
    forced = planned(config(f"{name}: on"))
    grown = {*forced.spec.effects, *forced.spec.shape_pairs}
    before = {*derived.spec.effects, *derived.spec.shape_pairs}
    assert {name, *before} <= grown
    for other in (set(grown) - before) - {name}:
        assert f"needed by {name}" in forced.decisions[other].reason
    assert set(forced.forced) == grown - before
    for other in forced.spec.effects:
        assert set(BY_NAME[other].needs) <= set(forced.spec.effects)


def test_what_is_forced_on_says_what_the_scene_says() -> None:
    derived, forced = planned(config()), planned(config("friction: on"))
    assert forced.decisions["friction"].reason == (
        f"forced on; not required: {derived.decisions['friction'].reason}"
    )
    assert forced.decisions["rotation"].reason == (
        f"forced on, needed by friction; not required: {derived.decisions['rotation'].reason}"
    )
    assert forced.forced == dict.fromkeys(("friction", "contact_torque", "rotation"), "forced on")


def test_on_for_what_is_required_changes_nothing() -> None:
    derived, specified = planned(config(mu=0.5)), planned(config("friction: on", mu=0.5))
    assert (specified.spec, specified.decisions) == (derived.spec, derived.decisions)
    assert specified.forced == {}


@pytest.mark.parametrize("force", ["", ", force: true"])
def test_off_for_what_is_not_required_changes_nothing(force: str) -> None:
    derived, specified = planned(config()), planned(config(f"friction: off, box_box: off{force}"))
    assert (specified.spec, specified.decisions) == (derived.spec, derived.decisions)
    assert specified.forced == {}


def test_off_for_what_is_required_is_refused_with_the_reason() -> None:
    text = config("drag: off, restitution: off")
    reason = planned(config()).decisions["restitution"].reason
    assert refused(text) == [
        f"{where(text, 'restitution')}: effects.restitution: the scene requires it: {reason}; "
        "add `force: true` beside it to leave it out all the same"
    ]


def test_force_leaves_out_what_is_required() -> None:
    derived, forced = planned(config()), planned(config("restitution: off, force: true"))
    assert forced.spec == derived.spec.without("restitution")
    assert forced.decisions["restitution"].reason == (
        f"forced off, though: {derived.decisions['restitution'].reason}"
    )
    assert forced.forced == {"restitution": "forced off"}
    assert forced.required_by == derived.required_by  # the scene requires it as before


@pytest.mark.parametrize(
    ("switches", "mu"), [("friction: on, rotation: off", 0.0), ("rotation: off, force: true", 0.5)]
)
def test_off_is_refused_while_something_needs_it(switches: str, mu: float) -> None:
    text = config(switches, mu=mu)
    assert refused(text) == [
        f"{where(text, 'rotation')}: effects.rotation: contact_torque, friction need it; "
        "switch those off as well"
    ]


def test_what_needs_it_can_be_switched_off_as_well() -> None:
    text = config("rotation: off, contact_torque: off, friction: off, force: true", mu=0.5)
    # What is frictionless stays a matter of the coefficients, see `frictionless_contact`.
    assert planned(text).spec == planned(config()).spec.without("frictionless_contact")


@pytest.mark.parametrize("name", CHOSEN)
def test_a_law_is_chosen_by_the_numerics_alone(name: str) -> None:
    key = choice(name).key
    chosen, other = LAWS[name]
    preset = f"{{{key}: {other}}}"
    text = config(f"{name}: on", mu=0.5, numerics=preset)
    assert refused(text) == [
        f"{where(text, name)}: effects.{name}: it is another law, no idle effect; "
        f"write `numerics: {{{key}: {chosen}}}` to choose it"
    ]
    for force in ("", ", force: true"):
        text = config(f"{name}: off{force}", mu=0.5, numerics=f"{{{key}: {chosen}}}")
        text = text.replace("numerics:", ANOTHER + "numerics:").replace("surface: {", SOFT)
        assert refused(text) == [
            f"{where(text, name)}: effects.{name}: the numerics choose it; "
            f"write `numerics: {{{key}: {other}}}` instead"
        ]


# With an accuracy there is something to do wherever something moves.
@pytest.mark.parametrize("name", [name for name in CHOSEN if name != "error_control"])
def test_a_law_that_the_numerics_chose_can_be_had_idle(name: str) -> None:
    """Nothing touches or falls here: the law has nothing to do, and is no other law."""
    numerics = f"{{{choice(name).key}: {LAWS[name][0]}}}"
    alone = config(f"{name}: on", numerics=numerics).replace(
        "  bodies:\n", "  gravity: [0, 0, 0]\n  bodies:\n"
    )
    floor = next(line for line in alone.splitlines(keepends=True) if "floor: {" in line)
    alone = alone.replace(floor, "").replace(
        "release: {above: floor, clearance: 0.05}", "position: [0, 0, 1]"
    )
    assert not planned(alone.replace(f"effects: {{{name}: on}}\n", "")).spec.has(name)
    assert planned(alone).forced == dict.fromkeys((name, *needs(name)), "forced on")


def test_a_mistake_is_chosen_by_the_study_alone() -> None:
    text = config(f"{MISTAKE}: on")
    assert refused(text) == [
        f"{where(text, MISTAKE)}: effects.{MISTAKE}: it is another law, no idle effect; "
        f"write `study: {{mistake: {MISTAKE}}}` to choose it"
    ]
    study = f"study: {{mistake: {MISTAKE}}}\n"
    assert planned(study + config()).spec == planned(config()).spec.including(MISTAKE)
    text = study + config(f"{MISTAKE}: off, force: true")
    assert refused(text) == [
        f"{where(text, MISTAKE)}: effects.{MISTAKE}: the study chooses it; "
        "write `study: {mistake: none}` instead"
    ]


def test_a_mistake_that_has_nothing_to_spoil_is_not_made() -> None:
    study = f"study: {{mistake: {MISTAKE}}}\n"
    assert planned(study + config(e=0.0)).spec == planned(config(e=0.0)).spec


def test_what_needs_another_law_names_its_key() -> None:
    text = config("impact_energy: on")
    assert refused(text) == [
        f"{where(text, 'impact_energy')}: effects.impact_energy: it needs impact_time, which is "
        "another law, no idle effect; write `numerics: {impacts: at_surface}` to choose it"
    ]


def test_sums_of_contacts_are_not_lost_with_the_contacts() -> None:
    """/step has their number and forces from the kernel that logs them; it would say zero."""
    text = config("contact_log: off, force: true")
    assert refused(text) == [
        f"{where(text, 'contact_log')}: effects.contact_log: the sums in /step are those of the "
        "contacts that are logged; leave it on"
    ]


@pytest.mark.parametrize("name", ["step_log", "pose_log"])
def test_a_run_keeps_its_log(name: str) -> None:
    text = config(f"{name}: off, force: true")
    assert refused(text) == [
        f"{where(text, name)}: effects.{name}: a run without its log is no run; leave it on"
    ]


def test_bodies_that_may_touch_do_not_pass_through_each_other() -> None:
    text = config("sphere_plane: off, force: true")
    assert refused(text) == [
        f"{where(text, 'sphere_plane')}: effects.sphere_plane: floor and ball may touch; "
        "without it they would pass through each other"
    ]


def test_unknown_names_are_reported_with_the_nearest() -> None:
    text = config("frction: on, box_bix: on, gravity: on")
    said = "no effect or shape pair is called"
    assert refused(text) == [
        f'{where(text, "frction")}: effects.frction: {said} "frction"; did you mean "friction"?',
        f'{where(text, "box_bix")}: effects.box_bix: {said} "box_bix"; did you mean "box_box"?',
    ]


def test_every_refusal_of_a_file_is_reported_at_once() -> None:
    assert len(refused(config("gravity: off, restitution: off, drga: on, midpoint: on"))) == 4


@pytest.mark.parametrize("switch", ["on", "off"])
def test_what_is_switched_is_part_of_what_an_engine_is_shared_by(switch: str) -> None:
    assert planned(config(f"friction: {switch}")).choices != planned(config()).choices
