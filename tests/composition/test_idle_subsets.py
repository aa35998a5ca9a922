"""Random scenes and random subsets of the effects that they do not require: no bit changes.

A kind of scene holds what decides its plan (shapes, numerics, which coefficients are zero) and
draws the rest: how many bodies, sizes, masses, places, motions, surfaces. Its scenes therefore
share one pruned engine and a fuller one for each subset. A subset is drawn at random for each kind;
the effects that it leaves out are the next one, so that two subsets hold every effect that may
idle, in company that nobody chose.

Kernels run in the interpreter. `LAVENDER_TEST_EVERYTHING=1` compiles the engines, which is what it
costs then, and draws 30 scenes of 2 s on each; `LAVENDER_TEST_SUBSETS` and `LAVENDER_TEST_SCENES`
draw more.
"""

from __future__ import annotations

import os
import random
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from idle import MODULES, Run, closed, compile_together, differences, may_idle
from idle_scenes import BRICK, CONJUGATE, CUBE, cell
from laboratory import box, plane, planned, sphere

from lavendersim.engine.spec import Spec
from tests.thorough import THOROUGH

SUBSETS = int(os.environ.get("LAVENDER_TEST_SUBSETS", "2"))
SCENES = int(os.environ.get("LAVENDER_TEST_SCENES", "30" if THOROUGH else "2"))
# 2 s: bodies that bounced apart have come to rest, most of them; 0.3 s: they have met.
STEPS = 480 if THOROUGH else 72
SOME = settings(
    max_examples=SCENES,
    deadline=None,
    derandomize=True,
    database=None,
    phases=[Phase.explicit, Phase.generate],  # to shrink a scene is to run hundreds
    suppress_health_check=[HealthCheck.too_slow],
)
unit = st.floats(-1.0, 1.0, allow_subnormal=False, width=32)
share = st.floats(0.0, 1.0, allow_subnormal=False, width=32)
some = st.floats(0.0625, 1.0, allow_subnormal=False, width=32)
nothing = st.just(0.0)
vector = st.tuples(unit, unit, unit)
# Half a metre apart: what flies to the middle meets there within a few steps.
CORNERS = 0.5 * np.array([(0, 0, 0.5), (1, 0, 1), (0, 1, 1), (-1, 0, 1), (0, -1, 1)], float)


def _round(draw: Any, place: Any, **properties: Any) -> dict[str, Any]:
    return sphere(0.12 + 0.04 * draw(unit), place, **properties)


def _tumbling(draw: Any, place: Any, size: Any, **properties: Any) -> dict[str, Any]:
    turn, spin = np.array([1.0, *draw(vector)]), 3.0 * np.array(draw(vector))
    return box(size, place, orientation=turn, angular_velocity=spin, **properties)


def _cube(draw: Any, place: Any, **properties: Any) -> dict[str, Any]:
    return _tumbling(draw, place, np.array(CUBE) * (1.0 + 0.3 * draw(unit)), **properties)


def _brick(draw: Any, place: Any, **properties: Any) -> dict[str, Any]:
    # No two edges become equal: its inertia has no two equal moments.
    return _tumbling(
        draw, place, np.array(BRICK) * (1.0 + 0.1 * np.array(draw(vector))), **properties
    )


@st.composite
def bodies(draw: Any, shapes: Any, fewest: int, **surface: Any) -> dict[str, Any]:
    """A floor and bodies that fall on it and fly to the middle; the first has the first shape."""
    drawn = {name: draw(some) for name, values in surface.items() if values is not nothing}
    scene = {"floor": plane(**drawn)}
    for i in range(draw(st.integers(fewest, len(CORNERS)))):
        make = shapes[i] if i < len(shapes) else draw(st.sampled_from(shapes))
        scene[f"body_{i}"] = make(
            draw,
            CORNERS[i] + 0.04 * np.array(draw(vector)),
            velocity=(-4.0, -4.0, -2.0) * CORNERS[i] + np.array(draw(vector)),
            mass=10.0 ** draw(unit),
            # The first has friction and bounces if any does: the plan is the kind's.
            **{name: draw(values if i else some) if values is not nothing else 0.0
               for name, values in surface.items()},
        )  # fmt: skip
    return scene


def smooth(draw: Any) -> dict[str, Any]:
    """Frictionless bricks and balls that bounce, by the chapter's numerics."""
    return cell(draw(bodies((_brick, _round), 3, restitution=share)), preset="chapter")


def rough(draw: Any) -> dict[str, Any]:
    """Balls of which some are frictionless and some do not bounce, by lavender's own numerics."""
    surface = {"friction": st.one_of(nothing, share), "restitution": st.one_of(nothing, share)}
    scene = draw(bodies((_round,), 3, **surface))
    scene["body_1"]["surface"]["friction"] = 0.0
    scene["body_0"]["velocity"] = [12.0, 1.0, -8.0]  # so fast that any two may be
    return cell(scene, preset="default")


def conjugate(draw: Any) -> dict[str, Any]:
    """Balls and cubes of which all have friction and none bounces, by conjugate gradients."""
    return cell(draw(bodies((_cube, _round), 3, friction=some)), **CONJUGATE)


class Kind:
    """A kind of scene: its draws, its engine, and its subsets of idle effects."""

    def __init__(self, draw: Callable[[Any], dict[str, Any]]) -> None:
        self.scenes = st.composite(draw)()
        self.name = draw.__name__
        self.pairs = ("box_box", "box_plane", "sphere_box", "sphere_plane", "sphere_sphere")
        if draw is rough:
            self.pairs = self.pairs[3:]

    def engines(self, cell: dict[str, Any]) -> tuple[Spec, list[Spec]]:
        """Return the pruned engine and one for each subset."""
        lean = planned(cell).spec._replace(shape_pairs=self.pairs)
        idle = [name for name in MODULES if may_idle(cell, name)]
        draws = random.Random(self.name)
        fuller = []
        for k in range(SUBSETS):
            if k % 2 == 0:
                subset = {name for name in idle if draws.random() < 0.5}
            else:
                subset = set(idle) - subset
            fuller.append(lean.including(*closed(*subset)))
        return lean, fuller


KINDS = [Kind(draw) for draw in (smooth, rough, conjugate)]


@pytest.fixture(scope="module", autouse=True)
def compiled() -> None:
    """Compile the engines of all kinds on both cores, where they are to be."""
    if not THOROUGH:
        return
    engines = []
    for kind in KINDS:
        cell = first(kind)
        lean, fuller = kind.engines(cell)
        engines += [(cell, spec) for spec in (lean, *fuller)]
    compile_together(engines)


def first(kind: Kind) -> dict[str, Any]:
    """Return some scene of a kind."""
    found = []

    @settings(SOME, max_examples=1)
    @given(kind.scenes)
    def draw(scene: dict[str, Any]) -> None:
        found.append(scene)

    draw()
    return found[0]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_random_subsets_of_idle_effects_change_no_bit(kind: Kind) -> None:
    lean, fuller = kind.engines(first(kind))
    assert all(set(full.effects) > set(lean.effects) for full in fuller)
    contacts = []

    @SOME
    @given(kind.scenes)
    def equal(scene: dict[str, Any]) -> None:
        assert planned(scene).spec.effects == lean.effects
        one = Run(scene, lean, STEPS, interpreted=not THOROUGH)
        contacts.append(len(one.tables["contact"]))
        for full in fuller:
            compare(one, Run(scene, full, STEPS, interpreted=not THOROUGH), full)

    equal()
    assert max(contacts) > 100


def compare(one: Run, other: Run, full: Spec) -> None:
    """Compare a run with that of a fuller engine."""
    more_sweeps = ("sweeps",) if full.has("residual_log") or full.has("broad_phase") else ()
    assert differences(one, other, *more_sweeps) == []
    if not full.has("residual_log"):
        # A pair out of reach of each other, which the broad phase does not list, may have a
        # contact ahead that one sweep finds to be none: it is not logged, and pushes nothing.
        steps, others = one.tables["step"], other.tables["step"]
        touch = steps["contact_count"] > 0
        assert np.array_equal(steps["sweeps"][touch], others["sweeps"][touch])
        assert (others["sweeps"][~touch] <= steps["sweeps"][~touch]).all()


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_two_subsets_hold_every_effect_that_may_idle(kind: Kind) -> None:
    cell = first(kind)
    lean, (one, other, *_) = kind.engines(cell)
    idle = {name for name in MODULES if may_idle(cell, name)}
    assert idle
    assert set(one.effects) | set(other.effects) == set(lean.effects) | idle
