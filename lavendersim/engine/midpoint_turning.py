"""Whether what contacts' rows are made of turns within a step (`effects.contact_midpoint`)."""

from __future__ import annotations

from math import sqrt
from typing import Any

from .approach import gained
from .collide.nearest_image import place_beside
from .collide.records import UNBOUNDED
from .collide.shapes import shapes_in
from .compile import kernel
from .effects import has_hook
from .midpoint_rows import SAME
from .records import BOX, PLANE, SPHERE
from .rotation import is_round
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms
from .vectors import Vec3, into_body, minus

# What round-off leaves of a velocity, as a share of the bodies' speed to each other [-].
ROUND_OFF = 1e-13


def make_stays_flat(spec: Spec) -> Any:
    """Return `kernel(a, b, m, dt) -> whether` B is a ball whose row on the fixed A is constant.

    m: B's motion. Its lever is -r n, and n is that of a plane, or of a face of a box that it does
    not leave before the middle of the step. None where no ball meets either.
    """
    kinds = {shape.kind for shape in shapes_in(spec)}
    if SPHERE not in kinds or not kinds & {PLANE, BOX}:
        return None
    boxes = BOX in kinds
    kinematic, uneven = step_terms(spec).kinematic, step_terms(spec).uneven
    sprung, carries = step_terms(spec).sprung, has_hook(spec, "surface_velocity")
    beside_a: Any = place_beside(spec)

    def stays_flat(a, b, m, dt):
        if b.shape != SPHERE or a.inv_m != 0.0:
            return False
        if kinematic:
            if a.kinematic == 1 or b.kinematic == 1:
                return False
        if uneven:
            if not is_round(b):
                return False
        if sprung:
            if b.sprung > 0:
                return False
        if carries:  # its surface's velocity turns with it
            if b.sx != 0.0 or b.sy != 0.0 or b.sz != 0.0:
                return False
        if boxes:
            if a.shape == BOX:
                c = into_body(a, minus(beside_a(a, b), a))
                v, dv = into_body(a, Vec3(m.vx, m.vy, m.vz)), into_body(a, gained(m))
                beside = 0
                for at, half, way in (
                    (c.x, a.hx, abs(v.x) + abs(dv.x)),
                    (c.y, a.hy, abs(v.y) + abs(dv.y)),
                    (c.z, a.hz, abs(v.z) + abs(dv.z)),
                ):
                    outside = abs(at) - half
                    if outside + way * dt < 0.0:
                        beside += 1
                    elif outside - way * dt <= 0.0:
                        return False
                return beside == 2
        return a.shape == PLANE

    return kernel(stays_flat, spec)


def _make_asks_the_same(spec: Spec) -> Any:
    """Return the same kernel of a row's friction."""
    yielding, stretched = row_terms(spec).yielding, row_terms(spec).stretched

    def asks_the_same(contact, speed):
        # Of a row with friction: no surface moves, and none is along the slip of the start, which
        # would count at the middle (`begin_slip`).
        same = contact.surface_1 == 0.0 and contact.surface_2 == 0.0
        if yielding:
            same = same and contact.yield_k == 0.0
        if stretched:
            same = same and contact.stretched == 0
        x, y, z = contact.begin_x, contact.begin_y, contact.begin_z
        one, two = contact.lambda_1, contact.lambda_2
        work = one * (contact.t1x * x + contact.t1y * y + contact.t1z * z)
        work += two * (contact.t2x * x + contact.t2y * y + contact.t2z * z)
        return same and work <= ROUND_OFF * speed * (abs(one) + abs(two))

    return kernel(asks_the_same, spec)


def make_is_plain(spec: Spec) -> Any:
    """Return `kernel(contact, speed) -> whether` its row at the middle asks what it asks at first.

    Where nothing turns it. speed: of its bodies to each other, of which it may leave round-off.
    """
    terms = row_terms(spec)
    springs = terms.elastic
    ropes, bilateral, coupled = terms.taut, terms.bilateral, terms.coupled
    friction, frictionless, swept = terms.frictional, terms.frictionless, terms.swept

    asks_the_same: Any = _make_asks_the_same(spec) if friction else None

    def is_plain(contact, speed):
        plain = contact.lasts == 0 or contact.begin_n <= ROUND_OFF * speed
        if springs:
            plain = plain and contact.spring_compliance == 0.0
        if ropes:
            plain = plain and contact.span == 0.0
        if bilateral:
            plain = plain and contact.bilateral == 0
        if coupled:
            off = abs(contact.patch_x) + abs(contact.patch_y) + abs(contact.patch_z)
            plain = plain and off == 0.0
        if swept:
            aside = abs(contact.tangential_x) + abs(contact.tangential_y)
            plain = plain and aside + abs(contact.tangential_z) == 0.0
        if friction:
            frictional = True
            if frictionless:
                frictional = contact.frictional == 1
            if frictional:
                plain = plain and asks_the_same(contact, speed)
        return plain

    return kernel(is_plain, spec)


def make_is_turning(spec: Spec) -> Any:
    """Return `kernel(contacts, count, bodies, motion, params) -> whether the geometry changes`.

    Asked of rows that `begin_slip` has looked at.
    """
    turns, ropes = step_terms(spec).turns, row_terms(spec).taut
    stays_flat = make_stays_flat(spec)
    balls = stays_flat is not None
    is_plain: Any = make_is_plain(spec) if balls else None

    def is_turning(contacts, count, bodies, motion, params):
        for c in range(count):
            contact = contacts[c]
            ma, mb = motion[contact.a], motion[contact.b]
            x, y, z = mb.vx - ma.vx, mb.vy - ma.vy, mb.vz - ma.vz
            speed = sqrt(x * x + y * y + z * z)
            body_a, body_b = bodies[contact.a], bodies[contact.b]
            rate, size = 0.0, UNBOUNDED
            if body_a.shape != PLANE:
                size = body_a.bound
            if body_b.shape != PLANE:
                size = min(size, body_b.bound)
            if body_a.shape != PLANE and body_b.shape != PLANE:
                rate = speed / size
            if ropes:
                if contact.span > 0.0:
                    rate = max(rate, speed / contact.span)
            if turns:
                spin = sqrt(ma.wx * ma.wx + ma.wy * ma.wy + ma.wz * ma.wz)
                spin += sqrt(mb.wx * mb.wx + mb.wy * mb.wy + mb.wz * mb.wz)
                rate += spin
                speed += spin * size
            if rate * speed * params.dt > SAME:
                flat = False
                if balls:
                    flat = stays_flat(body_a, body_b, mb, params.dt) and is_plain(contact, speed)
                if not flat:
                    return True
        return False

    return kernel(is_turning, spec)
