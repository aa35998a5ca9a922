"""Swept manifolds of two bodies, each with its displacement over a step."""

from __future__ import annotations

import hashlib
from functools import cache
from math import sqrt
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import poses

from lavendersim.engine.collide import SHAPE_PAIRS, swept
from lavendersim.engine.collide.convex.separation import make_separation
from lavendersim.engine.collide.manifold.point import place, put_manifold_normal
from lavendersim.engine.collide.narrow_phase import make_manifold
from lavendersim.engine.collide.scratch import allocate_scratch
from lavendersim.engine.compile import compiling, kernel
from lavendersim.engine.kernel_cache import cached
from lavendersim.engine.records import BOX, SPHERE, TOUCHING, VELOCITY, dtype
from lavendersim.engine.spec import Spec
from lavendersim.engine.vectors import Vec3

DT = 1.0 / 60.0  # [s]
CLOSED = ("sphere_box", "sphere_sphere")
GENERAL = ("box_box",)
_TEXT = hashlib.sha256(Path(__file__).read_bytes()).hexdigest()[:8]


class Sweep(NamedTuple):
    """Points (n, 3), gaps at the start (n,), normal, time of the meeting [s], v_n [m/s]."""

    points: np.ndarray
    phi: np.ndarray
    normal: np.ndarray
    time: float
    v_n: float
    fast: bool


def askew_manifold(spec: Spec, sine: float) -> Any:
    """Return a manifold of one point whose normal is turned about z, away from the true one."""
    separation, cosine = make_separation(spec), sqrt(1.0 - sine * sine)

    def askew(kind, a, b, margin, scratch):
        gap, n = separation(kind, a, b, scratch)
        turned = Vec3(cosine * n.x - sine * n.y, sine * n.x + cosine * n.y, n.z)
        put_manifold_normal(scratch.manifold, turned)
        place(scratch.manifold.points[0], Vec3(0.0, 0.0, 0.0), gap, 0)
        return 1

    return kernel(askew, spec)


@cache
def swept_kernel(pairs: tuple[str, ...], sine: float) -> Any:
    """Return the kernel for these shape pairs, kept on disk; normals askew by `sine`."""

    def compose(spec: Spec) -> Any:
        manifold = make_manifold(spec, spec.shape_pairs)
        if sine:
            manifold = askew_manifold(spec, sine)
        swept_manifold = swept.make_swept_manifold(spec, manifold)
        is_fast = swept.make_is_fast(spec)

        def sweep(kind, bodies, velocities, dt, margin, scratch):
            a, b, va, vb = bodies[0], bodies[1], velocities[0], velocities[1]
            d = Vec3((vb.vx - va.vx) * dt, (vb.vy - va.vy) * dt, (vb.vz - va.vz) * dt)
            fast = is_fast(a, b, d)
            count, t = swept_manifold(kind, a, b, d, margin, scratch)
            return count, t * dt, fast

        return kernel(sweep, spec)

    return cached(compose, Spec(("rotation", "speculative"), pairs, f"swept {sine} {_TEXT}"))


class Pair:
    """Two bodies, A and B as the kernel of their shapes takes them, and their velocities."""

    def __init__(self, pair: str, half_a, half_b, centre_b, turn_a=None, turn_b=None) -> None:
        self.pairs = CLOSED if pair in CLOSED else GENERAL
        self.kind, shapes = SHAPE_PAIRS[pair].kind, SHAPE_PAIRS[pair].shapes
        self.bodies = poses.allocate(2)
        poses.put(self.bodies[0], half_a, matrix=turn_a)
        poses.put(self.bodies[1], half_b, centre_b, turn_b)
        for row, shape in zip(self.bodies, shapes, strict=True):
            row["shape"] = {"sphere": SPHERE, "box": BOX}[shape]
        self.velocities = np.zeros(2, dtype(VELOCITY))

    def moves(self, body: int, velocity) -> Pair:
        """Set the velocity of A (0) or B (1) [m/s]."""
        for name, value in zip(("vx", "vy", "vz"), velocity, strict=True):
            self.velocities[body][name] = value
        return self

    @property
    def relative(self) -> np.ndarray:
        """Velocity of B relative to A [m/s]."""
        a, b = (np.array(list(row)) for row in self.velocities)
        return b - a

    def sweep(self, margin: float = TOUCHING, sine: float = 0.0) -> Sweep:
        """Return what the kernel finds; it must leave the bodies as they were."""
        scratch = allocate_scratch()
        points, normal = scratch.manifold[:2]
        before = self.bodies.copy()
        with compiling():
            count, time, fast = swept_kernel(self.pairs, sine)(
                self.kind, self.bodies, self.velocities, DT, margin, scratch
            )
        assert self.bodies.tobytes() == before.tobytes()
        places = np.column_stack([points[axis][:count] for axis in "xyz"])
        v_n = float(self.relative @ normal)
        return Sweep(places, points["phi"][:count].copy(), normal, time, v_n, fast)
