"""Fat bounds: the box and the sphere that a body may not leave while the list of pairs is kept.

Bounding volumes enlarged by a margin, as the fat AABBs of E. Catto's Box2D: those of the shape,
grown by

    reach + slack,   slack = min(SHARE R, STEPS reach)        R bounding radius, reach: `reach`

and, when few bodies are so fast that they leave that within a step, those are followed STEPS steps
ahead along their velocity. Two bodies are a pair when their fat bounds overlap. The list is valid
as long as every body, grown by what it can reach in the coming step, lies in its fat bounds: a pair
that is not listed is then farther apart than both can reach. A body that was moved, turned or
thrown from outside fails the same test. Extra pairs only cost time: no contact depends on when the
list was made.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...effects import has_hook
from ...records import COMPOUND, F8, PLANE, TOUCHING, Field
from ...spec import Spec
from ..shape_kernels import make_half_extents
from .reach import make_reach

# Larger: fewer lists, more pairs that are looked at in vain. For packed spheres stirred at 1 m/s
# (tests/benchmarks/broad_phase.py) a step costs the same from 0.25 to 0.4, with 4 to 16 steps, and
# half as much again at 0.1.
SHARE = 0.25
STEPS = 8.0
# Followed ahead are at most this share of the bodies: more of them would be many pairs.
FEW = 1.0 / 64.0

FAT_BOUNDS: list[Field] = [
    ("x", F8),  # centre of box and sphere [m]
    ("y", F8),
    ("z", F8),
    ("ex", F8),  # half edges of the box [m]
    ("ey", F8),
    ("ez", F8),
    ("radius", F8),  # how far from (x, y, z) the centre of mass may be, with its reach [m]
]


def make_is_valid(spec: Spec):
    """Return `kernel(bodies, velocities, params, fat_bounds) -> whether the list is valid`."""
    half_extents, reach = make_half_extents(spec), make_reach(spec)
    compound = has_hook(spec, "place_parts")

    def is_valid(bodies, velocities, params, fat_bounds):
        for i in range(bodies.shape[0]):
            body, fat = bodies[i], fat_bounds[i]
            if body.shape == PLANE or body.shape == COMPOUND:
                continue
            owner = i
            if compound:
                owner = body.owner
            need = reach(bodies[owner], velocities[owner], params) + TOUCHING
            dx, dy, dz = abs(body.x - fat.x), abs(body.y - fat.y), abs(body.z - fat.z)
            half = half_extents(body)
            left = fat.radius - need
            # Written so that a NaN fails.
            if not (
                left >= 0.0
                and dx * dx + dy * dy + dz * dz <= left * left
                and dx + (half.x + need) <= fat.ex
                and dy + (half.y + need) <= fat.ey
                and dz + (half.z + need) <= fat.ez
            ):
                return False
        return True

    return kernel(is_valid, spec)


def make_place_bounds(spec: Spec):
    """Return `kernel(bodies, velocities, params, fat_bounds)`: write those of every body."""
    half_extents, reach = make_half_extents(spec), make_reach(spec)
    compound = has_hook(spec, "place_parts")

    def place_bounds(bodies, velocities, params, fat_bounds):
        fast, count = 0, bodies.shape[0]
        for i in range(count):
            owner = i
            if compound:
                owner = bodies[i].owner
            far = reach(bodies[owner], velocities[owner], params)
            fat_bounds[i].radius = far
            if far > SHARE * bodies[i].bound and bodies[i].shape != PLANE:
                fast += 1
        follow = fast <= FEW * count
        for i in range(count):
            body, fat = bodies[i], fat_bounds[i]
            if body.shape == PLANE or body.shape == COMPOUND:
                continue
            far = fat.radius
            slack = min(SHARE * body.bound, STEPS * far)
            grow = far + TOUCHING + slack
            ahead_x, ahead_y, ahead_z = 0.0, 0.0, 0.0
            if follow and far > slack:
                owner = i
                if compound:
                    owner = body.owner
                v, half_way = velocities[owner], 0.5 * STEPS * params.dt
                ahead_x, ahead_y, ahead_z = v.vx * half_way, v.vy * half_way, v.vz * half_way
            half = half_extents(body)
            fat.x, fat.y, fat.z = body.x + ahead_x, body.y + ahead_y, body.z + ahead_z
            fat.ex = half.x + grow + abs(ahead_x)
            fat.ey = half.y + grow + abs(ahead_y)
            fat.ez = half.z + grow + abs(ahead_z)
            fat.radius = grow + sqrt(ahead_x * ahead_x + ahead_y * ahead_y + ahead_z * ahead_z)

    return kernel(place_bounds, spec)
