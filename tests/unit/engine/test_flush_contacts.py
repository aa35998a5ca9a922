"""A box that slides from tile to tile passes over the side of the next, up to a step of its height.

Two tiles lie side by side, and the box on the first; the second is lower or higher by a step, and
the manifold of the box and the second tile has the normal of its side. Bodies are turned at random,
mirrored, and either may be A.
"""

from __future__ import annotations

from itertools import permutations
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest
import solid_poses
from drawn_contacts import put_vector, random_frame
from interpreted import interpreted, records
from plain_facts import one_row

from lavendersim.engine.approach import CREEP, FAR, GUESSED, make_approach
from lavendersim.engine.collide.scratch import allocate_scratch
from lavendersim.engine.contact_lists import allocate_contact_lists
from lavendersim.engine.flush_contacts import FLUSH, make_drop_flush
from lavendersim.engine.record_layout import allocate_bodies, allocate_pairs, contact_dtype
from lavendersim.engine.records import MOTION, TOUCHING, dtype
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("impact_order", "rotation"), shape_pairs=("box_box",))
DROP_FLUSH = interpreted(make_drop_flush(SPEC))
APPROACH = interpreted(make_approach(SPEC))
SLOP = 1e-5
HALF = (0.5, 0.4, 0.1)  # of each tile, and of the box above the first [m]
FIRST, SECOND, BOX = range(3)
LIMIT = FLUSH * SLOP + TOUCHING


class Scene(NamedTuple):
    """The box on the first tile, and its two contacts."""

    step: float = 0.0  # the second tile's top above the first's [m]
    gap: float = 0.0  # between the box and the side of the second tile [m]
    velocity: tuple[float, float, float] = (1.0, 0.0, 0.0)  # of the box
    rests: float = 0.0  # separation from the first tile [m]
    turned: np.ndarray = np.eye(3)  # an orthogonal matrix
    exchanged: tuple[bool, bool] = (False, False)  # whether the box is A of its contacts
    order: tuple[int, int, int] = (0, 1, 2)  # rows of the three bodies
    located: int = GUESSED

    def rows(self) -> tuple[SimpleNamespace, SimpleNamespace]:
        """Return the engine's state and workspace."""
        bodies, motion = allocate_bodies(SPEC, 3), np.zeros(3, dtype(MOTION))
        # Of a box a mirrored frame is the same box.
        proper = self.turned * np.linalg.det(self.turned)
        x = HALF[0]
        centres = ((-x, 0.0, -HALF[2]), (x, 0.0, self.step - HALF[2]), (-x - self.gap, 0, HALF[2]))
        for i, centre in zip(self.order, centres, strict=True):
            solid_poses.put(bodies[i], "box", HALF, self.turned @ centre, proper)
            bodies["bound"][i] = np.linalg.norm(HALF)
        bodies["inv_m"] = 0.0
        bodies["inv_m"][self.order[BOX]] = 1.0
        put_vector(motion[self.order[BOX]], "v", self.turned @ self.velocity)
        pairs, contacts = allocate_pairs(SPEC, 2), np.zeros(2, contact_dtype(SPEC))
        touched = ((FIRST, (0, 0, 1), (-x, 0, 0)), (SECOND, (-1, 0, 0), (-0.5 * self.gap, 0, 0.0)))
        for k, (tile, normal, place) in enumerate(touched):
            row, n = contacts[k], self.turned @ normal
            ends = self.order[tile], self.order[BOX]
            if self.exchanged[k]:
                ends, n = ends[::-1], -n
            row["a"], row["b"], row["pair"], row["located"] = *ends, k, self.located
            pairs["a"][k], pairs["b"][k] = ends
            put_vector(row, "n", n)
            put_vector(row, "", self.turned @ place)
        contacts["phi"] = self.rests, self.gap
        state = SimpleNamespace(
            bodies=records(bodies),
            motion=records(motion),
            pairs=records(pairs),
            contacts=records(contacts),
        )
        for contact in state.contacts:
            contact.rate = APPROACH(contact, state.bodies, state.motion)
        workspace = SimpleNamespace(
            collision=records(allocate_scratch(None)),
            contact_lists=records(allocate_contact_lists(3, 2)),
        )
        return state, workspace

    def dropped(self) -> bool:
        """Return whether the second tile's contact is dropped; the first never is."""
        state, workspace = self.rows()
        count = DROP_FLUSH(state, 2, workspace, one_row(slop=SLOP))
        first = state.contacts[0]
        assert first.pair == 0
        assert first.passed_on == 2 - count
        return count == 1


def ways(rng: np.random.Generator, scene: Scene) -> list[Scene]:
    """Return the scene turned, mirrored, exchanged and with its bodies in any order."""
    made = []
    for order in permutations(range(3)):
        for exchanged in ((False, False), (True, True), (True, False), (False, True)):
            turned = random_frame(rng) @ np.diag([1.0, rng.choice([-1.0, 1.0]), 1.0])
            made.append(scene._replace(order=order, exchanged=exchanged, turned=turned))
    return made


@pytest.mark.parametrize("gap", [0.0, 0.02])
@pytest.mark.parametrize("step", [0.0, -0.01, 0.99 * LIMIT, 1.01 * LIMIT])
def test_a_step_up_to_the_limit_is_passed_over_and_a_higher_one_met(step, gap, rng) -> None:
    for scene in ways(rng, Scene(step=step, gap=gap)):
        assert scene.dropped() == (step < LIMIT)


def test_what_comes_down_on_the_second_tile_meets_it(rng) -> None:
    """The top of the tile parts the two, but they approach along its normal."""
    for scene in ways(rng, Scene(velocity=(1.0, 0.0, -1e-3))):
        assert not scene.dropped()
    for scene in ways(rng, Scene(velocity=(1.0, 0.0, 1e-3))):
        assert scene.dropped()


def test_a_box_that_does_not_rest_passes_over_nothing(rng) -> None:
    """What is beyond the slop from the first tile has no normal of it to slide along."""
    above = SLOP + TOUCHING
    for rests, flush in ((0.99 * above, True), (1.01 * above, False)):
        for scene in ways(rng, Scene(rests=rests))[:4]:
            assert scene.dropped() == flush


@pytest.mark.parametrize("speed", [0.0, -1.0, 0.5 * CREEP, 2.0 * CREEP])
def test_a_contact_that_does_not_approach_stays_unless_it_is_ahead(speed: float) -> None:
    """Across a gap it is about to be passed on to; what no part of the step reaches is left."""
    along, approaches = (speed, 0.0, 0.0), speed > CREEP
    assert Scene(velocity=along).dropped() == approaches
    assert Scene(velocity=along, gap=1.01 * SLOP).dropped()
    assert Scene(velocity=along, gap=0.99 * SLOP).dropped() == approaches
    assert Scene(velocity=along, gap=0.1, located=FAR).dropped() == approaches


def kept_with(scene: Scene, **first: float) -> int:
    """Return how many rows are kept, with the first contact changed."""
    state, workspace = scene.rows()
    for name, value in first.items():
        state.contacts[0][name] = value
    return int(DROP_FLUSH(state, 2, workspace, one_row(slop=SLOP)))


def test_rows_of_one_pair_or_of_one_normal_say_nothing_of_each_other() -> None:
    lower = Scene(step=-0.3)
    assert kept_with(lower, pair=1) == 2
    for scene in (lower, Scene(velocity=(0.0, 0.0, 0.0), gap=0.1)):
        assert kept_with(scene) == 1
        assert kept_with(scene, nx=-1.0, ny=0.0, nz=0.0) == 2


def test_planes_have_no_edges() -> None:
    assert make_drop_flush(SPEC._replace(shape_pairs=("box_plane", "sphere_plane"))) is None
