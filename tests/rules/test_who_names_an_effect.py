"""Which files name an effect that is not theirs, each with its reason; no other does.

What a hook of the step or a declaration says is no reason, nor what contacts' rows are made of:
those are terms that effects declare (`RowTerms`).
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from sources import ROOT, module_of, modules

from lavendersim.engine.effects import EFFECTS, Effect

LIST = "lavendersim/engine/effects/__init__.py"
EFFECT_FILES = "lavendersim.engine.effects."
CHAINED = [effect for effect in EFFECTS if effect.hooks.accelerate or effect.hooks.capture]
FACT = "a property of the scene, which predicates may ask for, has the same name"
TIME = "what gives way takes time: no impact of an instant"
SPRING = "it has a penetration of its own, and no impact"
BOUNCES = "with it bounces are no powers of e"
LAW = "a row ahead of touching must be looked for, and its body's flight be kept"
# Where else a name stands, as an identifier or a string, and why it must. A soft row is a term of
# rows (`RowTerms`), which solvers ask for.
ELSEWHERE = {
    "gravity": {
        "engine/effects/decision.py": FACT,
        "scene/facts.py": FACT,
        "scene/laws.py": FACT,
        "scene/events.py": "its vector changes during the run",
        "scene/build.py": "its vector is a parameter of the run, with the other coefficients",
        "engine/effects/fast_bodies.py": "how fast bodies may fall",
        "engine/effects/impact_order.py": "what drives a ball along a plane",
        "scene/expected_contacts.py": "how soon bodies have landed",
    },
    "external_force": {
        "scene/events.py": "forces begin and end during the run",
    },
    "compliance": {
        "engine/effects/pairwise_impacts.py": TIME,
        "engine/effects/fast_bodies.py": "springs give energy back",
        "engine/effects/impact_order.py": TIME,
        "engine/foreseen_impacts.py": TIME,
        "engine/impact_rows.py": TIME,
        "engine/repeated_bounces.py": BOUNCES,
        "engine/spring_surfaces.py": "gives energy back",
        "engine/effects/contact_spring.py": "is another law of it",
    },
    "contact_spring": {
        "engine/effects/pairwise_impacts.py": SPRING,
        "engine/effects/impact_order.py": SPRING,
        "engine/foreseen_impacts.py": SPRING,
        "engine/impact_rows.py": SPRING,
        "engine/midpoint_jumps.py": SPRING,
        "engine/effects/impact_time.py": SPRING,
        "engine/effects/projection.py": SPRING,
        "engine/midpoint_rows.py": SPRING,
        "engine/spring_surfaces.py": "what it stores is known",
        "engine/spring_unions.py": "stores energy",
    },
    "cohesion": {"engine/repeated_bounces.py": BOUNCES},
    "drag": {"engine/repeated_bounces.py": BOUNCES},
    "restitution": {
        "engine/effects/capture_in_sweeps.py": "makes a mistake with it",
        "engine/effects/falling_restitution.py": "lowers its coefficient",
        "engine/effects/fast_bodies.py": "captured, it gives energy",
        "engine/effects/impact_energy.py": "takes the place of its law",
        "engine/effects/rope.py": "a rope has one of its own, by the same name",
        "scene/ropes.py": "a rope has one of its own, by the same name",
        "engine/effects/impact_order.py": "impacts that rebound take more rows",
        "engine/foreseen_impacts.py": "a rebound tells an impact from a lasting contact",
        "engine/overlooked_points.py": "a rebound tells an impact from a lasting contact",
        "engine/spring_contacts.py": "rebounds beside springs may give energy",
    },
    "speculative": {
        "engine/effects/decision.py": FACT,
        "scene/facts.py": FACT,
        "scene/plan.py": "numerics choose this law: cells that differ in it share no engine",
        "engine/effects/fast_bodies.py": "finds where to look ahead",
        "engine/effects/contact_log.py": "rows ahead that never push are not logged",
        "engine/integrate.py": LAW,
        "engine/collide/iteration_limits.py": "which pairs look how far apart their bodies are",
        "engine/collide/narrow_phase.py": LAW,
        "engine/collide/pairs/box_box.py": LAW,
    },
}
# Which files ask for an effect by its name (`spec.has`, or by an import of its file), and why it is
# no matter of a hook or of a declaration. An effect that is not here is asked for by nothing.
ASKED = {
    "degrees of freedom: what has an orientation, or moves though nothing moves it": {
        "rotation": (
            *("applied_force", "approach", "collide/broad/reach", "effects/drag"),
            *("effects/prescribed_motion", "effects/varying_force"),
            *("effects/impact_order", "effects/pose_log", "effects/sleeping", "effects/spring"),
            *("effects/step_log", "effects/velocity_log", "error_estimate", "foreseen_impacts"),
            "impact_location",
            *("integrate", "midpoint_geometry", "midpoint_mixing", "midpoint_passes"),
            "midpoint_rows",
            "overlooked_points",
            *("solvers/newton/minimise", "spring_midpoint", "step_doubling", "scene/events"),
            *("effects/projection", "spring_contacts", "spring_group", "spring_limit"),
            *("spring_projection", "spring_surfaces", "spring_unions"),
        ),
        "gyroscopic": ("integrate", "midpoint_geometry", "spring_midpoint", "spring_turn"),
        "kinematic": ("effects/sleeping", "integrate", "midpoint_geometry", "spring_surfaces"),
        "compound": (
            *("collide/broad/broad_phase", "collide/broad/fat_bounds", "collide/narrow_phase"),
            "impact_location",
        ),
    },
    "laws of the step: where poses move, and when; each has modules of the step of its own": {
        "midpoint": (
            *("collide/narrow_phase", "contact", "effects/cohesion", "effects/drag"),
            *("effects/projection", "effects/speculative", "effects/spring", "integrate"),
        ),
        "contact_midpoint": (
            *("contact", "effects/contact_spring", "effects/friction", "effects/projection"),
            *("effects/joint", "effects/motor", "effects/prescribed_motion"),
            *("integrate", "joint_turn", "memory", "respond"),
        ),
        "impact_time": (
            *("contact", "effects/cohesion", "effects/drag", "effects/restitution"),
            *("effects/projection", "effects/speculative", "integrate", "midpoint_passes"),
            "repeated_bounces",
        ),
        "impact_order": (
            *("effects/impact_time", "effects/overlooked_points", "effects/sliding_stops"),
            *("contact", "effects/warm_start", "memory", "midpoint_geometry"),
            *("parts", "repeated_bounces", "respond", "runner/log_size", "spring_contacts"),
        ),
        "overlooked_points": (
            *("collide/narrow_phase", "collide/pairs/cylinder_plane", "foreseen_impacts"),
            *("impact_location", "impact_rows", "memory", "midpoint_geometry", "respond", "step"),
        ),
        "spring": ("effects/projection", "integrate", "repeated_bounces"),
        "error_control": (
            *("effects/projection", "effects/warm_start", "parts", "step", "step_doubling"),
        ),
        "speculative": (
            *("collide/iteration_limits", "collide/narrow_phase", "collide/pairs/box_box"),
            *("effects/contact_log", "integrate"),
        ),
        "fast_bodies": (
            *("block", "collide/iteration_limits", "collide/narrow_phase", "collide/swept"),
            "contact",
            *("effects/contact_midpoint", "midpoint_geometry", "midpoint_rows"),
        ),
        "contact_spring": (
            *("effects/impact_order", "effects/impact_time", "effects/pairwise_impacts"),
            *("effects/projection", "foreseen_impacts", "impact_rows", "midpoint_jumps"),
            *("midpoint_rows", "spring_surfaces", "spring_unions"),
        ),
        "compliance": ("foreseen_impacts", "repeated_bounces", "spring_surfaces"),
        "cohesion": ("repeated_bounces",),
        "drag": ("repeated_bounces",),
        "restitution": (
            *("effects/impact_order", "foreseen_impacts", "overlooked_points", "spring_contacts"),
        ),
        "projection": ("integrate", "memory"),
    },
    "rows that collision detection does not make: of what connects two ends": {
        "rope": (
            *("approach", "collide/narrow_phase", "contact", "effects/impact_order"),
            *("foreseen_impacts", "midpoint_geometry", "midpoint_rows", "spec"),
            *("scene/facts", "scene/ropes", "effects/__init__"),
        ),
        "joint": (
            *("collide/broad/broad_phase", "collide/narrow_phase", "effects/triggers"),
            *("flush_contacts", "spec", "scene/joints"),
        ),
        "joint_stop": ("scene/joints",),
        "motor": ("scene/joints",),
    },
    "arrays that an engine has only with it, and who is awake": {
        "sleeping": (
            *("collide/broad/broad_phase", "effects/step_log", "effects/triggers", "engine"),
            *("flush_contacts", "memory", "step_doubling"),
        ),
        "broad_phase": ("engine", "memory", "scene/events", "scene/pair_tables"),
        "warm_start": ("memory", "step_doubling"),
        "step_log": ("engine", "step", "step_doubling"),
        "pose_log": ("step",),
        "velocity_log": ("memory",),
        "contact_log": ("effects/triggers", "respond"),
        "triggers": ("scene/events", "scene/trigger_table"),
        "problem_log": ("memory",),
        "external_force": ("scene/events",),
    },
    "a part of one solver": {
        "newton": ("effects/least_norm", "joint_projection", "solvers/adaptive"),
        "least_norm": ("solvers/adaptive", "scene/plan"),
        "packed_sweeps": ("solvers/packed/late",),
    },
}


def names(file: Path) -> set[str]:
    """Return the identifiers and strings of a source file; prose and docstrings are none."""
    found = set()
    for node in ast.walk(ast.parse(file.read_text())):
        for field in ("id", "attr", "arg", "name", "module"):
            found.add(getattr(node, field, None))
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            found.add(node.value)
    return {name for name in found if isinstance(name, str)}


@pytest.mark.parametrize("effect", CHAINED, ids=lambda effect: effect.name)
def test_nothing_else_names_an_effect(effect: Effect) -> None:
    own = {LIST, f"lavendersim/engine/effects/{effect.name}.py"}
    files = [
        path for room in ("engine", "scene") for path in (ROOT / "lavendersim" / room).rglob("*.py")
    ]
    naming = {
        path.relative_to(ROOT / "lavendersim").as_posix()
        for path in files
        if path.relative_to(ROOT).as_posix() not in own and effect.name in names(path)
    }
    assert naming == set(ELSEWHERE.get(effect.name, ()))


def asked(file: Path) -> set[str]:
    """Return the effects that a source file asks for by name, or imports."""
    found = set()
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Call) and getattr(node.func, "attr", None) == "has":
            found |= {one.value for one in node.args if isinstance(one, ast.Constant)}
        elif isinstance(node, ast.Subscript) and getattr(node.value, "id", None) == "BY_NAME":
            found |= {one.value for one in [node.slice] if isinstance(one, ast.Constant)}
        for target in modules(node, module_of(file)[:-1]):
            if target.startswith(EFFECT_FILES):
                found.add(target.removeprefix(EFFECT_FILES).partition(".")[0])
    return found & {effect.name for effect in EFFECTS} - {file.stem}


def test_only_the_files_that_are_listed_ask_for_an_effect_by_name() -> None:
    """What contacts' rows are made of is no reason: those are terms that effects declare."""
    asking: dict[str, set[str]] = {}
    for path in (ROOT / "lavendersim").rglob("*.py"):
        name = path.relative_to(ROOT / "lavendersim").with_suffix("").as_posix()
        for effect in asked(path):
            asking.setdefault(effect, set()).add(name.removeprefix("engine/"))
    listed = {effect: {*files} for group in ASKED.values() for effect, files in group.items()}
    assert asking == listed
