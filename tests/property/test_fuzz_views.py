"""Drawn scenes turned, shifted, in a mirror and listed otherwise move as their image does.

Few sweeps and deep overlap make a drawn scene's motion as sensitive as it likes, so each is its own
measure: how far the same scene gets from itself where its bodies stand, turn and fly by 1e-13 of
what they do otherwise. A view rounds each number once or twice more, by 1e-16 of it: a thousandth
of that is due. What it may be off by is ten times that, for three samples do not find the worst
direction, and 1e-11 of the largest number. Small bodies far away turn by more, as much as moves
their ends by 1e-13 of where they stand: contacts act at places of the world, and arms are
differences of these. Steps from which on a scene is known to 1e-4 of its
numbers at best say nothing.

Before that all is moved by 1e-3: where bodies stand at one place, or faces are parallel, a view
decides otherwise what nothing decides. What few sweeps leave depends on the order of contacts:
other lists, and mirrors, which take the corners of a face the other way round, are judged while
steps are solved to 1e-11 of the speeds; other lists only without friction, whose laws alone have
one motion, and without projection, of whose sweeps no residual says what they leave. Tangents of a
pyramid follow the axes of the world: it is not turned.

Of plans with spheres, boxes, capsules and compounds of them: rims are met to 1e-6 of a turn, see
`test_zoo_symmetries`. In other units of length and time: `fuzz_constants`, of mass: `fuzz_units`,
both to the bit. `LAVENDER_TEST_VIEWS` draws more than 24 configs; `python
tests/property/test_fuzz_views.py PLAN SEED FIRST COUNT` draws them on another plan.
"""

from __future__ import annotations

import os
import sys
from typing import Any

import numpy as np
import pytest
from fuzz import compiled, drawn, drawn_plans
from fuzz_laws import loaded, run
from fuzz_views import View, nudged

from lavendersim.cell import CellConfig
from lavendersim.engine.spec import Spec

CONFIGS = int(os.environ.get("LAVENDER_TEST_VIEWS", "24"))
NUDGE, APART, SAMPLES = 1e-13, 1e-3, 3
TIMES, ROUND_OFF, LOST, SOLVED = 10.0, 1e-11, 1e-4, 1e-11
TURN = np.array([1.0, 0.3, -0.7, 0.45])
VIEWS = (
    View("shifted", shift=(0.5, -0.25, 0.125)),
    View("turned", turn=tuple((TURN / np.linalg.norm(TURN)).tolist())),
    View("mirrored", mirror=True),
    View("listed otherwise", order=1),
)


def apart(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return how far poses are from each other (steps, bodies, 4): place, turn, velocity, spin."""
    parts = [np.abs(one[..., k] - other[..., k]).max(-1)
             for k in (slice(0, 3), slice(7, 10), slice(10, 13))]  # fmt: skip
    q, p = one[..., 3:7], other[..., 3:7]
    turn = np.minimum(np.abs(q - p).max(-1), np.abs(q + p).max(-1))
    return np.stack([parts[0], turn, *parts[1:]], axis=-1)


def has_friction(cell: CellConfig) -> bool:
    """Whether some surface has friction of any kind."""
    bodies = cell.scene.bodies.values()
    kinds = ("friction", "torsional_friction", "rolling_friction")
    return any(getattr(body.surface, kind) > 0.0 for body in bodies for kind in kinds)


def is_judged(view: View, cell: CellConfig) -> bool:
    """Whether a scene's laws are those of its image."""
    if view.order is not None:
        moved = cell.events or cell.triggered or cell.numerics.projection > 0.0
        return not has_friction(cell) and not moved
    return view.turn[0] == 1.0 or cell.numerics.friction_cone != "pyramid"


def seen_otherwise(
    tree: dict[str, Any], spec: Spec, views: tuple[View, ...]
) -> tuple[list[str], int]:
    """Return what differs of a config's images, and how many steps were compared."""
    cell = nudged(loaded(tree)[0].cells()[0].config, APART, 0)
    plain = run(cell, spec, cell.steps)
    if plain.said or cell.scene.springs:  # unions that are not found take seconds
        return [], 0
    poses = plain.rows.pose
    known = np.zeros((*poses.shape[:2], 4))
    for sample in range(SAMPLES):
        moved = nudged(cell, NUDGE, sample, arms=True)
        other = run(moved, spec, cell.steps).rows.pose
        if other.shape != poses.shape:
            return [], 0
        known = np.maximum(known, apart(poses, other))
    known = np.maximum.accumulate(known, axis=0)
    planes = [body.shape.kind == "plane" for body in cell.scene.bodies.values()]
    sizes = np.array([np.abs(poses[..., k]).max() for k in (slice(3), slice(7, 10), slice(10, 13))])
    sizes = np.array([sizes[0], 1.0, *sizes[1:]])
    lost = (known > LOST * sizes).any(axis=(1, 2))
    found, compared = [], 0
    for view in views:
        if not is_judged(view, cell):
            continue
        image = run(view.config(cell), spec, cell.steps)
        if image.said:
            found.append(f"{view.name}: {image.said}")
            continue
        ends = lost
        if view.mirror or view.order is not None:
            residuals = np.maximum(plain.rows.step["residual"], image.rows.step["residual"])
            ends = lost | (residuals > SOLVED * sizes[2])
        whole = int(np.argmax(ends)) if ends.any() else len(ends)
        places = view.names(cell.scene.bodies)
        rows = [places.index(name) for name in cell.scene.bodies]
        off = apart(image.rows.pose[:, rows], view.poses(poses, planes))[:whole]
        off /= [view.length, 1.0, view.length / view.time, 1.0 / view.time]
        wrong = off > TIMES * known[:whole] + ROUND_OFF * sizes
        compared += whole
        if wrong.any():
            step, body, part = (int(k) for k in np.argwhere(wrong)[0])
            said = f"{off[step, body, part]:.3g}, known to {known[step, body, part]:.3g}"
            what = ("place", "turn", "velocity", "spin")[part]
            name = [*cell.scene.bodies][body]
            found.append(f"{view.name}: {what} of {name} in step {step} is off by {said}")
    return found, compared


def judged(
    plan: Any, seed: int, numbers: range, views: tuple[View, ...] = VIEWS
) -> tuple[list[str], int]:
    """Return what differs of the images of drawn configs, and how many steps were compared."""
    spec, said, compared = compiled(plan), [], 0
    for number in numbers:
        with np.errstate(over="ignore", invalid="ignore"):
            found, steps = seen_otherwise(drawn(plan, "view", seed, number), spec, views)
        said += [f"{number}: {one}" for one in found]
        compared += steps
    return said, compared


@pytest.mark.usefixtures("optimised")
def test_a_drawn_scene_seen_otherwise_moves_as_its_image() -> None:
    said, compared = judged(drawn_plans(1)[0], 0, range(CONFIGS))
    assert said == []
    assert compared > 10 * CONFIGS


@pytest.mark.usefixtures("optimised")
def test_an_image_of_the_wrong_hand_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(View, "axial", View.polar)
    said, _ = judged(drawn_plans(1)[0], 0, range(24))
    assert {one.split(":")[1] for one in said} == {" mirrored"}


if __name__ == "__main__":
    asked, seed, first, count = (int(one) for one in sys.argv[1:5])
    plan = drawn_plans(asked + 1, seed)[asked]
    lines, steps = judged(plan, seed, range(first, first + count))
    print(*lines, f"{count} configs, {steps} steps compared, {len(lines)} differ", sep="\n")
