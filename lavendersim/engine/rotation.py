"""Orientation kernels: quaternion to matrix, world inertia, and a turn without trigonometry.

The turn is the Cayley map, dq = (1, omega dt / 2) normalised: a rotation about omega by
2 atan(|omega| dt / 2). It is second order in dt and uses only sqrt, whose bits agree on every CPU.
In substeps as long as an accuracy allows (`error_control`) what keeps its spin turns exactly, by
|omega| dt: the series of a small part of the turn, doubled as often as it was halved.
"""

from __future__ import annotations

from math import sqrt

from .compile import inner

# Square of the half angle [rad^2] whose sine and cosine a few terms of their series are, and how
# often a turn is halved for it at most: one of 1e18 rad has no digits.
SMALL, MOST_DOUBLINGS = 1.0 / 64.0, 64


@inner
def orient(body):
    """Refresh the matrix of `body` from its unit quaternion."""
    w, x, y, z = body.qw, body.qx, body.qy, body.qz
    body.r00 = 1.0 - 2.0 * (y * y + z * z)
    body.r01 = 2.0 * (x * y - w * z)
    body.r02 = 2.0 * (x * z + w * y)
    body.r10 = 2.0 * (x * y + w * z)
    body.r11 = 1.0 - 2.0 * (x * x + z * z)
    body.r12 = 2.0 * (y * z - w * x)
    body.r20 = 2.0 * (x * z - w * y)
    body.r21 = 2.0 * (y * z + w * x)
    body.r22 = 1.0 - 2.0 * (x * x + y * y)


@inner
def is_round(body):
    """Whether its inertia is the same about every axis: a free spin does not change."""
    return body.inv_ix == body.inv_iy and body.inv_iy == body.inv_iz


@inner
def to_world(body, x, y, z):
    """Rotate a vector from the body's frame to the world's."""
    return (
        body.r00 * x + body.r01 * y + body.r02 * z,
        body.r10 * x + body.r11 * y + body.r12 * z,
        body.r20 * x + body.r21 * y + body.r22 * z,
    )


@inner
def to_body(body, x, y, z):
    """Rotate a vector from the world's frame to the body's."""
    return (
        body.r00 * x + body.r10 * y + body.r20 * z,
        body.r01 * x + body.r11 * y + body.r21 * z,
        body.r02 * x + body.r12 * y + body.r22 * z,
    )


@inner
def inverse_inertia_times(body, x, y, z):
    """I^-1 applied to a world vector, by way of the principal axes."""
    bx, by, bz = to_body(body, x, y, z)
    return to_world(body, body.inv_ix * bx, body.inv_iy * by, body.inv_iz * bz)


@inner
def inertia_times(body, x, y, z):
    """I applied to a world vector; a fixed body (inverse inertia 0) gives zero."""
    bx, by, bz = to_body(body, x, y, z)
    if body.inv_ix == 0.0:
        return 0.0, 0.0, 0.0
    return to_world(body, bx / body.inv_ix, by / body.inv_iy, bz / body.inv_iz)


@inner
def turn(body, angle_x, angle_y, angle_z):
    """Turn `body` by a small world rotation vector [rad] and refresh its matrix."""
    hx, hy, hz = 0.5 * angle_x, 0.5 * angle_y, 0.5 * angle_z
    w, x, y, z = body.qw, body.qx, body.qy, body.qz
    # dq * q with dq = (1, h): a world rotation multiplies from the left.
    nw = w - hx * x - hy * y - hz * z
    nx = x + hx * w + hy * z - hz * y
    ny = y + hy * w + hz * x - hx * z
    nz = z + hz * w + hx * y - hy * x
    scale = 1.0 / sqrt(nw * nw + nx * nx + ny * ny + nz * nz)
    body.qw, body.qx, body.qy, body.qz = nw * scale, nx * scale, ny * scale, nz * scale
    orient(body)


@inner
def turn_exactly(body, angle_x, angle_y, angle_z):
    """Turn `body` by a world rotation vector [rad] of any length and refresh its matrix."""
    hx, hy, hz = 0.5 * angle_x, 0.5 * angle_y, 0.5 * angle_z
    s, doublings = hx * hx + hy * hy + hz * hz, 0
    while s > SMALL and doublings < MOST_DOUBLINGS:
        s, doublings = 0.25 * s, doublings + 1
        hx, hy, hz = 0.5 * hx, 0.5 * hy, 0.5 * hz
    # 1 - cos a, and sin a over a, of the half angle a = sqrt(s); what follows is below 1e-17.
    versed = s / 2.0 * (1.0 - s / 12.0 * (1.0 - s / 30.0 * (1.0 - s / 56.0 * (1.0 - s / 90.0))))
    share = 1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0)))
    for _ in range(doublings):
        # 1 - cos 2a = 2 v (2 - v) and sin 2a = 2 sin a (1 - v), v = 1 - cos a: nothing cancels.
        share = 2.0 * share * (1.0 - versed)
        versed = 2.0 * versed * (2.0 - versed)
    dw, hx, hy, hz = 1.0 - versed, share * hx, share * hy, share * hz
    w, x, y, z = body.qw, body.qx, body.qy, body.qz
    nw = dw * w - hx * x - hy * y - hz * z
    nx = dw * x + hx * w + hy * z - hz * y
    ny = dw * y + hy * w + hz * x - hx * z
    nz = dw * z + hz * w + hx * y - hy * x
    scale = 1.0 / sqrt(nw * nw + nx * nx + ny * ny + nz * nz)
    body.qw, body.qx, body.qy, body.qz = nw * scale, nx * scale, ny * scale, nz * scale
    orient(body)


@inner
def half_turn(body, wx, wy, wz, dt):
    """Turn `body` by half of what `turn` by omega dt would: twice this is that."""
    whole = sqrt(1.0 + 0.25 * dt * dt * (wx * wx + wy * wy + wz * wz))
    share = dt / (1.0 + whole)
    turn(body, share * wx, share * wy, share * wz)
