"""The experiments that the benchmark of the line runs from config to verdict."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from lavendersim.experiment import Experiment, load_experiment_text
from lavendersim.runner import load_all

ROOT = Path(__file__).parents[2]
CHAPTER = ROOT / "configs" / "chapter"
SCENES = ROOT / "configs" / "scenes"
SHORTEST = "0.1"  # [s] of a run that only leaves its kernel on disk
# [s] as shipped. Spheres land for 1.5 s, and these steps cost the solver most: shorter runs flatter
# the ratio of logging to physics. The log grows evenly afterwards.
PILE_DURATION = 4.0
STEPS = 100_000  # of the long ball
FEW_STEPS = 1_000  # of the short one: what a cell costs by itself

SCENE = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      surface: {restitution: 0.5}
      release: {above: floor, clearance: 1.0}
"""
# Masses are no part of the motion, but cells of different masses are different simulations.
SWEEP = (
    SCENE
    + """\
numerics: {timestep: 1/RATE}
duration: 1.0
sweep:
  mass: {path: scene.bodies.ball.mass, values: [MASSES]}
  e: {path: scene.bodies.ball.surface.restitution, values: [RESTITUTIONS]}
always: {}
expect:
  - {name: it rebounds, measure: rebound, between: [0.0, 1.0]}
measure:
  rebound: {kind: first_apex, body: ball, above: floor}
"""
)
RESTITUTIONS = 20  # 0.1, 0.14, ..., 0.86
DROPS = SWEEP.replace("RATE", "240") + "  peak: {kind: peak_force, body: ball, other: floor}\n"
BRIEF = SWEEP.replace("RATE", "250")  # one measure

# One body of one contact: what a step costs the log at the least. It rests after 3 s.
BALL = (
    SCENE
    + """\
numerics: {timestep: 1/250}
duration: 4.0
always: {}
"""
)
BALL_RATE = 250  # [1/s]


class LineCase(NamedTuple):
    """Experiments that are run one after another; `warm` needs the same kernels, but less time."""

    name: str
    load: Callable[[], Sequence[Experiment]]
    warm: Callable[[], Sequence[Experiment]]


def drops(cells: int, text: str = DROPS) -> str:
    """Return the config of a sweep of drops; the cells are a multiple of RESTITUTIONS."""
    if cells % RESTITUTIONS:
        raise ValueError(f"{cells} drops: expected a multiple of {RESTITUTIONS}")
    masses = ", ".join(f"{0.5 + 0.05 * k:.2f}" for k in range(cells // RESTITUTIONS))
    restitutions = ", ".join(f"{0.1 + 0.04 * k:.2f}" for k in range(RESTITUTIONS))
    return text.replace("MASSES", masses).replace("RESTITUTIONS", restitutions)


def lasting(text: str, duration: float | str) -> str:
    """Return a config with another duration [s]."""
    changed, count = re.subn(r"(?m)^duration: [^\s#]+", f"duration: {duration}", text)
    if count != 1:
        raise ValueError(f"a config with {count} durations, expected 1")
    return changed


def of_text(name: str, text: str, warm: str) -> LineCase:
    """Return the case of a config given as text."""
    file = f"{name.replace(' ', '_')}.yaml"
    return LineCase(
        name,
        lambda: [load_experiment_text(text, file)],
        lambda: [load_experiment_text(warm, file)],
    )


def ball(steps: int) -> LineCase:
    """Return one ball of so many steps."""
    text = lasting(BALL, steps / BALL_RATE)
    return of_text(f"ball of {steps} steps", text, lasting(BALL, SHORTEST))


def cases(
    cells: int = 1000, pile_duration: float = PILE_DURATION, steps: int = STEPS
) -> list[LineCase]:
    """Return all cases; the long ball stands before the short one."""
    if steps <= FEW_STEPS:
        raise ValueError(f"a long ball of {steps} steps: expected more than {FEW_STEPS}")
    pyramid, pile = ((SCENES / f"{name}.yaml").read_text() for name in ("pyramid", "pile"))
    return [
        LineCase("chapter", lambda: load_all([CHAPTER]), lambda: load_all([CHAPTER])),
        of_text("drops", drops(cells), drops(RESTITUTIONS)),
        of_text("brief cells", drops(cells, BRIEF), drops(RESTITUTIONS, BRIEF)),
        of_text("pyramid", pyramid, lasting(pyramid, SHORTEST)),
        of_text("pile", lasting(pile, pile_duration), lasting(pile, SHORTEST)),
        ball(steps),
        ball(FEW_STEPS),
    ]
