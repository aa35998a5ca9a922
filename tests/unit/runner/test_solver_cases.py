"""Which cases are put to several solvers."""

from __future__ import annotations

from pathlib import Path

import pytest

from lavendersim.experiment import load_experiment, load_experiment_text
from lavendersim.runner.solver_cases import about_something_else

CANON = Path(__file__).parents[3] / "configs" / "hard"
SCENE = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 0.1]}
duration: 0.1
"""
CLAIM = """\
measure: {depth: {kind: max_penetration, body: ball}}
expect: [{name: rests, measure: depth, at_most: 1e-6}]
"""


def why(*sections: str) -> str:
    return about_something_else(load_experiment_text(SCENE + "".join(sections), "case.yaml"))


def swept(path: str, values: str) -> str:
    return f"sweep: {{one: {{path: {path}, values: {values}}}}}\n"


@pytest.mark.parametrize(
    "sections",
    [
        CLAIM,
        "always: {}\n",
        CLAIM + "numerics: default\n",
        CLAIM + "numerics: {timestep: 1/480}\n",
        CLAIM + swept("numerics.timestep", "[1/100, 1/200]"),
        CLAIM + swept("scene.bodies.ball.mass", "[1, 2]"),
        'always: {}\nexpect: [{name: "known failure, energy", fails: energy}]\n',
    ],
)
def test_a_case_of_the_default_numerics_is_put_to_every_solver(sections: str) -> None:
    assert why(sections) == ""


@pytest.mark.parametrize(
    ("sections", "said"),
    [
        ("", "judges nothing"),
        (CLAIM + "numerics: chapter\n", "is about the numerics chapter"),
        (CLAIM + "numerics: {preset: chapter}\n", "is about numerics of its own (chapter)"),
        (
            CLAIM + "numerics: {timestep: 1/480, warm_start: false, sweeps: 2}\n",
            "is about numerics of its own (sweeps, warm_start)",
        ),
        (CLAIM + "numerics: {solver: jacobi}\n", "is about numerics of its own (solver)"),
        (CLAIM + swept("numerics.solver", "[jacobi, adaptive]"), "varies numerics.solver"),
        (CLAIM + swept("numerics.sweeps", "[1, 2]"), "varies numerics.sweeps"),
        (
            CLAIM + "numerics: chapter\nstudy: {mistake: capture_in_sweeps}\n",
            "makes a deliberate error (capture_in_sweeps)",
        ),
        (
            "always: {}\nexpect: [{name: a gain wins energy, fails: energy}]\n",
            "must fail (a negative control)",
        ),
    ],
)
def test_what_asks_something_else_is_not_and_says_why(sections: str, said: str) -> None:
    assert why(sections) == said


def test_of_the_canon_what_must_fail_is_left_out_and_every_hard_case_is_in() -> None:
    said: dict[str, list[str]] = {}
    for path in CANON.rglob("*.yaml"):
        said.setdefault(path.parent.name, []).append(about_something_else(load_experiment(path)))
    # maps vary numerics; a find of the fuzz is kept with the numerics it was found with; grains of
    # crowds of grains take sweeps of their own
    for name in ("silo", "hopper", "hopper_slots", "drum_of_grains"):
        path = CANON / "crowd" / f"{name}.yaml"
        said["crowd"].remove(about_something_else(load_experiment(path)))
    kept_out = {name for name, reasons in said.items() if all(reasons)}
    assert {"control", "maps"} <= kept_out <= {"control", "maps", "found"}
    assert not [name for name, reasons in said.items() if any(reasons) and not all(reasons)]
    assert set(said["control"]) == {"must fail (a negative control)"}
