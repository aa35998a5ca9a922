"""Which files name an effect that is not theirs, each with its reason; no other does.

What a hook of the step or a declaration says is no reason, nor what contacts' rows are made of or
what a step reckons with: those are terms that effects declare (`RowTerms`, `StepTerms`).
"""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

import pytest
from sources import ROOT, module_of, modules

from lavendersim.engine.effects import EFFECTS, Effect

LIST = "lavendersim/engine/effects/__init__.py"
EFFECT_FILES = "lavendersim.engine.effects."
CHAINED = [effect for effect in EFFECTS if effect.hooks.accelerate or effect.hooks.capture]
FACT = "a property of the scene, which predicates may ask for, has the same name"
LOCAL = "a flag of that name, from the term `ahead`"
FIELD = "a field of pairs has the same name"
# Where else the name of an effect that accelerates bodies or captures contacts stands, as an
# identifier or a string, and why it must.
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
    "compliance": {
        "engine/row_terms.py": FIELD,
        "engine/foreseen_impacts.py": FIELD,
        "engine/spring_surfaces.py": FIELD,
        "engine/stiff_springs.py": FIELD,
        "engine/effects/decision.py": "which pairs give way",
        "engine/effects/impact_energy.py": "its impacts give back, too",
        "engine/effects/contact_spring.py": "is another law of it",
        "engine/effects/hertz_contact.py": "no compliance may be beside it",
        "engine/effects/tangential_compliance.py": "is in vain where all is rigid",
    },
    "contact_spring": {
        "engine/effects/hertz_contact.py": "is another law of it",
        "engine/effects/tangential_compliance.py": "needs it: it is by its stiffness",
    },
    "restitution": {
        "engine/effects/capture_in_sweeps.py": "makes a mistake with it",
        "engine/effects/falling_restitution.py": "lowers its coefficient",
        "engine/effects/fast_bodies.py": "captured, it gives energy",
        "engine/effects/impact_energy.py": "takes the place of its law",
        "engine/effects/rope.py": "a rope has one of its own, by the same name",
        "scene/ropes.py": "a rope has one of its own, by the same name",
        "engine/foreseen_impacts.py": FIELD,
        "engine/impact_rows.py": FIELD,
        "engine/overlooked_points.py": FIELD,
        "engine/stiff_springs.py": FIELD,
    },
    "speculative": {
        "engine/effects/decision.py": FACT,
        "scene/facts.py": FACT,
        "scene/plan.py": "numerics choose this law: cells that differ in it share no engine",
        "engine/effects/fast_bodies.py": "finds where to look ahead",
        "engine/effects/contact_log.py": LOCAL,
        "engine/collide/narrow_phase.py": LOCAL,
        "engine/collide/pairs/box_box.py": LOCAL,
    },
}
# Which files ask for an effect by its name (`spec.has`) or import its file, and why no hook or term
# answers that. An effect that is not here is asked for by nothing.
ASKED = {
    "newton": {
        "solvers/adaptive": "its rounds are a part of this solver",
        "effects/projection": "pushes that joints share are found by the same method",
        "effects/supernodes": "an order for its factor, where one may be required",
        "solvers/newton/factor": "joints are projected by its rounds with other solvers, too",
        "effects/least_norm": "chooses among what it leaves undetermined, by its factors",
    },
    "packed_sweeps": {
        "solvers/packed/late": "from which contact on this solver has them",
        "solvers/packed/team_sweeps": "of how many contacts threads share them",
        "engine": "of how many contacts a step has threads",
        "scene/explanation": "what threads would share",
        "effects/anderson_acceleration": "sweeps that begin from several are packed",
    },
    "anderson_acceleration": {
        "solvers/adaptive": "how many sweeps of a solve are plain",
        "solvers/packed/layout": "room for the sweeps that are kept",
    },
    "supernodes": {"solvers/newton/factor": "which of two factors a contact graph gets"},
    "least_norm": {"scene/plan": "how many bodies it is affordable for divides plans"},
    "impact_order": {
        "effects/overlooked_points": "where it is off, no part leaves a row out",
        "effects/sliding_stops": "where it is off, no part can end where sliding does",
    },
    "fast_bodies": {"collide/swept": "the share of a size that is fast, as it decides"},
    "sleeping": {"engine": "a change from outside wakes who sleeps beside it"},
    "pose_log": {"step": "its kernel makes what the row of a step hashes, logged or not"},
    "triggers": {"scene/trigger_table": "fills its table, by the numbers of its conditions"},
    "rope": {
        "spec": "steps may have contacts without any pair of shapes",
        "effects/__init__": "which of the scene's connections are ropes",
        "scene/ropes": "fills its rows",
        "scene/facts": "which bodies a rope may turn",
    },
    "joint": {"spec": "steps may have contacts without any pair of shapes"},
}


@cache
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
    found, package = set(), module_of(file)[:-1]
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Call) and getattr(node.func, "attr", None) == "has":
            found |= {one.value for one in node.args if isinstance(one, ast.Constant)}
        elif isinstance(node, ast.Subscript) and getattr(node.value, "id", None) == "BY_NAME":
            found |= {one.value for one in [node.slice] if isinstance(one, ast.Constant)}
        for target in modules(node, package):
            if target.startswith(EFFECT_FILES):
                found.add(target.removeprefix(EFFECT_FILES).partition(".")[0])
    return found & {effect.name for effect in EFFECTS} - {file.stem}


def test_only_the_files_that_are_listed_ask_for_an_effect_by_name() -> None:
    """What rows are made of and what a step reckons with is no reason: effects declare it."""
    asking: dict[str, set[str]] = {}
    for path in (ROOT / "lavendersim").rglob("*.py"):
        name = path.relative_to(ROOT / "lavendersim").with_suffix("").as_posix()
        for effect in asked(path):
            asking.setdefault(effect, set()).add(name.removeprefix("engine/"))
    assert asking == {effect: {*files} for effect, files in ASKED.items()}
