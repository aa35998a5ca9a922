"""Bodies enter, a region for each leaves: where it may be until the pairs are listed anew.

The region of a body is the box and the sphere of its shape, grown by

    reach + slack,   slack = min(SHARE R, STEPS reach)        R bounding radius, reach: `bounds`

and, when few bodies are so fast that they leave that within a step, those are followed STEPS steps
ahead along their velocity. Two bodies are a pair when their regions meet. The list serves as long
as every body, grown by what it can reach in the coming step, lies in its region: a pair that is
not listed is then farther apart than both can reach. A body that was moved, turned or thrown by
somebody else fails the same test. Extra pairs only cost time: no contact depends on when the list
was made.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...records import COMPOUND, F8, PLANE, TOUCHING, Field
from ...spec import Spec
from ..shapes import make_half_extents
from .bounds import make_reach

# Larger: fewer lists, more pairs that are looked at in vain. For packed spheres stirred at 1 m/s
# (tests/benchmarks/broad_phase.py) a step costs the same from 0.25 to 0.4, with 4 to 16 steps, and
# half as much again at 0.1.
SHARE = 0.25
STEPS = 8.0
# Followed ahead are at most this share of the bodies: more of them would be many pairs.
FEW = 1.0 / 64.0

REGION: list[Field] = [
    ("x", F8),  # centre of box and sphere [m]
    ("y", F8),
    ("z", F8),
    ("ex", F8),  # half edges of the box [m]
    ("ey", F8),
    ("ez", F8),
    ("radius", F8),  # how far from (x, y, z) the centre of mass may be, with its reach [m]
]


def make_holds(spec: Spec):
    """Return `kernel(bodies, velocities, params, regions) -> the list still serves`."""
    half_extents, reach = make_half_extents(spec), make_reach(spec)
    compound = spec.has("compound")

    def holds(bodies, velocities, params, regions):
        for i in range(bodies.shape[0]):
            body, region = bodies[i], regions[i]
            if body.shape == PLANE or body.shape == COMPOUND:
                continue
            owner = i
            if compound:
                owner = body.owner
            need = reach(bodies[owner], velocities[owner], params) + TOUCHING
            dx, dy, dz = abs(body.x - region.x), abs(body.y - region.y), abs(body.z - region.z)
            half = half_extents(body)
            left = region.radius - need
            # Asked so that a number that is none fails.
            if not (
                left >= 0.0
                and dx * dx + dy * dy + dz * dz <= left * left
                and dx + (half.x + need) <= region.ex
                and dy + (half.y + need) <= region.ey
                and dz + (half.z + need) <= region.ez
            ):
                return False
        return True

    return kernel(holds, spec)


def make_place_regions(spec: Spec):
    """Return `kernel(bodies, velocities, params, regions)`: the region of every body."""
    half_extents, reach = make_half_extents(spec), make_reach(spec)
    compound = spec.has("compound")

    def place_regions(bodies, velocities, params, regions):
        fast, count = 0, bodies.shape[0]
        for i in range(count):
            owner = i
            if compound:
                owner = bodies[i].owner
            far = reach(bodies[owner], velocities[owner], params)
            regions[i].radius = far
            if far > SHARE * bodies[i].bound and bodies[i].shape != PLANE:
                fast += 1
        follow = fast <= FEW * count
        for i in range(count):
            body, region = bodies[i], regions[i]
            if body.shape == PLANE or body.shape == COMPOUND:
                continue
            far = region.radius
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
            region.x, region.y, region.z = body.x + ahead_x, body.y + ahead_y, body.z + ahead_z
            region.ex = half.x + grow + abs(ahead_x)
            region.ey = half.y + grow + abs(ahead_y)
            region.ez = half.z + grow + abs(ahead_z)
            region.radius = grow + sqrt(ahead_x * ahead_x + ahead_y * ahead_y + ahead_z * ahead_z)

    return kernel(place_regions, spec)
