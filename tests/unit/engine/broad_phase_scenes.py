"""Random bodies in motion for the broad phase; what it must find, by trying every pair in numpy.

A pair must be listed when both its bounding spheres and its boxes, each grown by what the body can
reach in a step, meet. Boxes are taken around corners and rims that are computed one by one.
"""

from __future__ import annotations

import hashlib
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

import convex
import numpy as np

from lavendersim.engine.collide.broad import broad_phase
from lavendersim.engine.compile import compiling, kernel
from lavendersim.engine.effects import BY_NAME
from lavendersim.engine.kernel_cache import cached
from lavendersim.engine.record_layout import template_dtype
from lavendersim.engine.records import (
    ANGULAR_VELOCITY,
    BODY,
    BOWL,
    BOX,
    CAPSULE,
    COMPOUND,
    CYLINDER,
    DRUM,
    ORIENTED_BODY,
    PAIR,
    PARAMETERS,
    PLANE,
    SPHERE,
    TOUCHING,
    VELOCITY,
    dtype,
)
from lavendersim.engine.spec import Spec

SHAPES = ("box_plane", "capsule_plane", "cylinder_plane", "sphere_plane")
WITH_CAVITIES = ("box_drum", *SHAPES, "sphere_bowl")
SURFACE = [("friction", "f8"), ("restitution", "f8")]
# Classes of bodies: one per shape, of all walls one, and bodies that touch nothing.
MATERIALS = {PLANE: 0, COMPOUND: 0, BOWL: 0, DRUM: 0, SPHERE: 1, BOX: 2, CAPSULE: 3, CYLINDER: 4}
GHOST = 5
CLASSES = 6
BODY_RECORD = dtype(BODY, ORIENTED_BODY, BY_NAME["broad_phase"].fields.body, [("owner", "i8")])
_TEXT = hashlib.sha256(Path(__file__).read_bytes()).hexdigest()[:8]


@cache
def broad_phase_kernel(*effects: str, pairs: tuple[str, ...] = SHAPES) -> Any:
    """Return the kernel for the shapes above, kept on disk."""
    spec = Spec(tuple(sorted(("broad_phase", "rotation", *effects))), pairs, f"pairs {_TEXT}")

    def compose(spec: Spec) -> Any:
        find = broad_phase.make(spec, SURFACE)

        def find_pairs(bodies, velocities, pairs, templates, parameters, work):
            return find(bodies, velocities, pairs, templates, parameters[0], work)

        return kernel(find_pairs, spec)

    return cached(compose, spec)


def templates() -> np.ndarray:
    """Return classes whose pairs differ in kind, order and friction."""
    table = np.zeros((CLASSES, CLASSES), template_dtype(SURFACE))
    for c, d in product(range(CLASSES), repeat=2):
        touch = GHOST not in (c, d) and max(c, d) > 0
        table[c, d]["kind"] = CLASSES * min(c, d) + max(c, d) if touch else -1
        table[c, d]["friction"] = 0.1 * c + 0.1 * d
        table[c, d]["restitution"] = 0.1 * c * d
        table[c, d]["swap"] = (c, d) in ((1, 0), (2, 0), (1, 2))
    return table


def half_extents(row: np.void) -> np.ndarray:
    """Return half edges of the box of one body: farthest corner, or of 720 points of a rim [m]."""
    matrix = np.array([[row[f"r{r}{c}"] for c in range(3)] for r in range(3)])
    half = np.array([row["hx"], row["hy"], row["hz"]])
    if row["shape"] == BOX:
        return np.abs(convex.corners(convex.Box(np.zeros(3), matrix, half))).max(axis=0)
    if row["shape"] == CAPSULE:
        return np.abs(matrix @ np.array([0.0, 0.0, half[2]])) + half[0]
    if row["shape"] == CYLINDER:
        turn = 2.0 * np.pi * np.arange(720) / 720
        rim = np.stack([half[0] * np.cos(turn), half[0] * np.sin(turn), 0.0 * turn + half[2]])
        return np.abs(matrix @ rim).max(axis=1)
    return np.full(3, row["bound"])


class World:
    """Bodies in motion and the broad phase that follows them."""

    def __init__(
        self,
        count: int,
        *effects: str,
        gravity: float = 9.81,
        pairs: tuple[str, ...] = SHAPES,
    ) -> None:
        self.bodies = np.zeros(count, BODY_RECORD)
        self.velocities = np.zeros(count, dtype(VELOCITY, ANGULAR_VELOCITY))
        self.parameters = np.zeros(1, dtype(PARAMETERS))
        self.parameters["dt"], self.parameters["gz"] = 1.0 / 240.0, -gravity
        self.bodies["inv_m"] = 1.0
        self.bodies["owner"] = np.arange(count)
        self.kernel = broad_phase_kernel(*effects, pairs=pairs)
        self.templates = templates()
        self.failures = 0
        self.make_room(16)

    def make_room(self, rows: int) -> None:
        self.pairs = np.zeros(rows, dtype(PAIR, SURFACE))
        self.work = broad_phase.allocate_broad_phase(len(self.bodies), rows)

    def put(self, i: int, shape: int, half, centre=(0.0, 0.0, 0.0), matrix=None) -> None:
        """Fill row i: half edges, (radius,), (radius, 0, half length) or a plane's normal."""
        row = self.bodies[i]
        row["shape"], row["material"] = shape, MATERIALS[shape]
        for name, value in zip(("hx", "hy", "hz"), half, strict=False):
            row[name] = value
        row["bound"] = np.sum(half) if shape == CAPSULE else np.linalg.norm(half)
        row["x"], row["y"], row["z"] = centre
        self.turn(i, np.eye(3) if matrix is None else matrix)

    def turn(self, i: int, matrix: np.ndarray) -> None:
        for r, c in product(range(3), repeat=2):
            self.bodies[i][f"r{r}{c}"] = matrix[r, c]

    def listed(self) -> np.ndarray:
        """Run the broad phase, with more rows as often as it asks, and return the rows."""
        while True:
            with compiling():
                count = self.kernel(
                    self.bodies, self.velocities, self.pairs, self.templates, self.parameters,
                    self.work,
                )  # fmt: skip
            if count >= 0:
                return self.pairs[:count]
            self.failures += 1
            self.make_room(int(self.work.state["needed"][0]))

    @property
    def rebuilds(self) -> int:
        return int(self.work.state["rebuilds"][0])

    def move(self, dt: float) -> None:
        """Advance positions by dt v, orientations by one random turn of |omega| dt at most."""
        for axis in "xyz":
            self.bodies[axis] += dt * self.velocities[f"v{axis}"]

    def reach(self) -> np.ndarray:
        """Return what every body can reach in a step [m]: |v| dt + |omega| R dt + 2 g dt^2."""
        p, owner = self.parameters[0], self.bodies["owner"]
        v = np.linalg.norm([self.velocities[f"v{axis}"][owner] for axis in "xyz"], axis=0)
        w = np.linalg.norm([self.velocities[f"w{axis}"][owner] for axis in "xyz"], axis=0)
        falls = 2.0 * abs(p["gz"]) * p["dt"] ** 2 * (self.bodies["inv_m"][owner] > 0.0)
        return (v + w * self.bodies["bound"][owner]) * p["dt"] + falls

    def half_extents(self) -> np.ndarray:
        """Return half edges of the box of every body, shape (bodies, 3) [m]."""
        return np.array([half_extents(row) for row in self.bodies])

    def needed(self) -> set[int]:
        """Return the keys of all pairs that must be listed, from every pair there is."""
        b, count = self.bodies, len(self.bodies)
        centre = np.column_stack([b["x"], b["y"], b["z"]])
        reach, half = self.reach(), self.half_extents()
        i, j = np.triu_indices(count, 1)
        far = reach[i] + reach[j] + TOUCHING
        gap = np.abs(centre[i] - centre[j]) - half[i] - half[j]
        apart = np.linalg.norm(centre[i] - centre[j], axis=1) - b["bound"][i] - b["bound"][j]
        near = (gap.max(axis=1) <= far) & (apart <= far)
        for plane in np.flatnonzero(b["shape"] == PLANE):
            normal = np.array([b[name][plane] for name in ("hx", "hy", "hz")])
            height = centre @ normal - b["offset"][plane]
            low = height - np.minimum(b["bound"], half @ np.abs(normal)) <= reach + TOUCHING
            near[(i == plane) & low[j]] = True
            near[(j == plane) & low[i]] = True
            near[(i == plane) & ~low[j]] = False
            near[(j == plane) & ~low[i]] = False
        for cavity in np.flatnonzero(np.isin(b["shape"], (BOWL, DRUM))):  # all are inside
            near[(i == cavity) | (j == cavity)] = True
        still = b["inv_m"][b["owner"]] == 0.0
        near &= ~(still[i] & still[j]) & (b["owner"][i] != b["owner"][j])
        near &= (b["shape"][i] != COMPOUND) & (b["shape"][j] != COMPOUND)
        near &= self.templates["kind"][b["material"][i], b["material"][j]] >= 0
        return set((i[near] * count + j[near]).tolist())


def random_world(rng: np.random.Generator, *effects: str, pairs: tuple[str, ...] = SHAPES) -> World:
    """Some 150 bodies of all kinds, sizes over four decades, two planes, a tenth of them fixed."""
    count = int(rng.integers(2, 160))
    world = World(count, *effects, gravity=float(rng.choice([0.0, 9.81])), pairs=pairs)
    largest = 10.0 ** rng.uniform(-2.0, 2.0)
    spread = largest * 10.0 ** rng.uniform(-1.0, 0.5)
    for i in range(count):
        size = largest * 10.0 ** rng.uniform(-4.0, 0.0)
        centre = rng.normal(size=3) * spread
        if rng.random() < 0.02:
            normal = rng.normal(size=3)
            world.put(i, PLANE, normal / np.linalg.norm(normal))
            world.bodies["offset"][i] = rng.normal() * spread
            world.bodies["inv_m"][i] = 0.0
            world.bodies["bound"][i] = 0.0
        elif rng.random() < 0.5:
            world.put(i, SPHERE, (size,), centre)
            world.bodies["material"][i] = rng.choice([1, 1, 1, GHOST])
        else:
            half = size * 10.0 ** rng.uniform(-1.0, 0.0, 3)
            shape = rng.choice([BOX, CAPSULE, CYLINDER])
            if shape != BOX:
                half[1] = 0.0
            world.put(i, shape, half, centre, convex.random_rotation(rng))
        if rng.random() < 0.1:
            world.bodies["inv_m"][i] = 0.0
    for axis in "xyz":
        speeds = rng.normal(size=count) * 10.0 ** rng.uniform(-2.0, 2.0, count)
        world.velocities[f"v{axis}"] = np.where(world.bodies["shape"] == PLANE, 0.0, speeds)
        turns = rng.normal(size=count) * 10.0 ** rng.uniform(-2.0, 1.0, count)
        world.velocities[f"w{axis}"] = np.where(world.bodies["shape"] == PLANE, 0.0, turns)
    return world


def disturb(world: World, rng: np.random.Generator) -> None:
    """What happens between two steps of a run: mostly little."""
    if rng.random() < 0.5:  # all but a few come to rest
        resting = rng.random(len(world.bodies)) < 0.9
        for name in world.velocities.dtype.names:
            world.velocities[name][resting] *= 0.1
    chosen = int(rng.integers(len(world.bodies)))
    if world.bodies["shape"][chosen] == PLANE:
        return
    event = rng.random()
    if event < 0.1:  # teleport
        for axis in "xyz":
            world.bodies[axis][chosen] = rng.normal() * 10.0
    elif event < 0.3:
        world.velocities["vx"][chosen] = rng.normal() * 100.0
    elif event < 0.4 and world.bodies["inv_m"][chosen] > 0.0:
        world.bodies["inv_m"][chosen] *= 2.0
    elif event < 0.6:
        world.turn(chosen, convex.random_rotation(rng))
    elif event < 0.65:
        world.parameters["dt"] *= 2.0


def packed(count_along: int, radius: float = 0.05) -> World:
    """Spheres face to face on a cubic lattice above a plane."""
    world = World(count_along**3 + 1)
    world.put(0, PLANE, (0.0, 0.0, 1.0))
    world.bodies["inv_m"][0] = 0.0
    place = np.stack(np.meshgrid(*[np.arange(count_along)] * 3), axis=-1).reshape(-1, 3)
    for i, (x, y, z) in enumerate(place):
        world.put(i + 1, SPHERE, (radius,), 2.0 * radius * np.array([x, y, z + 0.5]))
    return world
