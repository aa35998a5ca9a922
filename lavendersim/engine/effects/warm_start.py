"""Warm start: contacts that persist begin at the impulse they ended with, scaled by dt/dt_cached.

A contact persists when the cache holds a point of the same pair within `cache_distance` of it, seen
from body A, whose normal still points the same way. The same feature is preferred; without one the
nearest unclaimed point serves. Rows of both lists are ordered by pair, so one walk matches all.
A row of a normal alone begins without tangential impulse and torque: an event took its friction.
So does one whose coefficient of torsional or rolling friction is 0: no sweep changes that torque.

Where impacts part a step, a part may be of any length: what a solve leaves (1e-9 m/s, times a mass)
does not shrink with it, and would be scaled to the next. Brief parts leave the cache as it is.
"""

from ..step_terms import step_terms
from .decision import Decision, Facts
from .effect import Effect, Fields, Hooks, kernel

# Share of a step from which on a part's impulses are kept: a thousandth of the impulses of a step
# is far above what solves leave.
BRIEF = 1e-3


def decide(facts: Facts) -> Decision:
    """On when the numerics ask for it and something can touch."""
    if facts.warm_start and facts.pairs:
        return Decision(True, "warm_start is true")
    return Decision(False, "nothing can touch" if facts.warm_start else "warm_start is false")


def make(spec):
    """Return `kernel(contacts, count, bodies, cache, counters, params)` that sets lambda_n."""
    from ..row_terms import row_terms

    friction = row_terms(spec).frictional
    terms = row_terms(spec)
    torsional, rolling, bilateral = terms.torsional, terms.rolling, terms.bilateral
    bounded, stretched = terms.bounded, terms.stretched
    mixed = friction and terms.frictionless

    def match_contacts(contacts, count, bodies, cache, counters, params):
        if counters.cached == 0:
            return
        scale = params.dt / counters.cached_dt
        nearest_allowed = params.cache_distance * params.cache_distance
        left = count
        # Features first, for all: a new point must not take the impulse of one that persists.
        for by_feature in (True, False):
            if left == 0:
                return
            first = 0
            for c in range(count):
                contact = contacts[c]
                if by_feature:
                    contact.matched = 0
                elif contact.matched == 1:
                    continue
                while first < counters.cached and cache[first].key < contact.key:
                    first += 1
                body = bodies[contact.a]
                rx, ry, rz = contact.x - body.x, contact.y - body.y, contact.z - body.z
                best, chosen = nearest_allowed, -1
                k = first
                while k < counters.cached and cache[k].key == contact.key:
                    old = cache[k]
                    if old.claimed == 0 and (not by_feature or old.feature == contact.feature):
                        cosine = old.nx * contact.nx + old.ny * contact.ny + old.nz * contact.nz
                        dx, dy, dz = old.rx - rx, old.ry - ry, old.rz - rz
                        distance = dx * dx + dy * dy + dz * dz
                        if bilateral:
                            if contact.bilateral == 1:  # wherever its bodies have turned
                                distance = 0.0
                        if bounded:
                            if contact.couple == 1:  # it has no normal
                                cosine = 1.0
                        if cosine >= params.cache_normal_cosine and distance <= best:
                            best, chosen = distance, k
                    k += 1
                if chosen >= 0:
                    cache[chosen].claimed = 1
                    contact.matched = 1
                    contact.lambda_n = cache[chosen].lambda_n * scale
                    share = scale
                    if mixed:
                        share = scale * contact.frictional
                    if friction:
                        # The impulse in the old tangent plane, in the new one; the first sweep
                        # brings it back into the disc.
                        old = cache[chosen]
                        contact.lambda_1 = share * (
                            contact.t1x * old.px + contact.t1y * old.py + contact.t1z * old.pz
                        )
                        contact.lambda_2 = share * (
                            contact.t2x * old.px + contact.t2y * old.py + contact.t2z * old.pz
                        )
                        if stretched:
                            contact.lambda_1 *= contact.ease_1
                            contact.lambda_2 *= contact.ease_2
                    # What begins without a push begins without torque: neither is applied.
                    if torsional:
                        if contact.lambda_n > 0.0 and contact.torsional > 0.0:
                            contact.psi_n = share * cache[chosen].psi_n
                    if rolling:
                        if contact.lambda_n > 0.0 and contact.rolling > 0.0:
                            old = cache[chosen]
                            x, y, z = share * old.psi_x, share * old.psi_y, share * old.psi_z
                            contact.psi_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
                            contact.psi_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
                    left -= 1

    return kernel(match_contacts, spec)


def make_store(spec):
    """Return `kernel(contacts, count, bodies, cache, counters, params)` that refills the cache."""
    from ..row_terms import row_terms

    friction = row_terms(spec).frictional
    terms = row_terms(spec)
    torsional, rolling, yielding = terms.torsional, terms.rolling, terms.yielding
    # Substeps are as short as an accuracy requires, one after the other.
    parted = step_terms(spec).ordered_impacts and not step_terms(spec).substeps

    def store_contacts(contacts, count, bodies, cache, counters, params):
        if parted:
            brief = params.dt < BRIEF * params.timestep and counters.cached > 0
            if yielding:  # no part of a stretch is too brief
                for c in range(count):
                    brief = brief and contacts[c].stretch_k == 0.0
            if brief:
                for k in range(counters.cached):
                    cache[k].claimed = 0
                return
        for c in range(count):
            contact, row = contacts[c], cache[c]
            body = bodies[contact.a]
            row.key, row.a, row.b = contact.key, contact.a, contact.b
            row.feature, row.claimed = contact.feature, 0
            row.rx, row.ry, row.rz = contact.x - body.x, contact.y - body.y, contact.z - body.z
            row.nx, row.ny, row.nz = contact.nx, contact.ny, contact.nz
            row.lambda_n = contact.lambda_n
            if friction:
                one, two = contact.lambda_1, contact.lambda_2
                row.px = contact.t1x * one + contact.t2x * two
                row.py = contact.t1y * one + contact.t2y * two
                row.pz = contact.t1z * one + contact.t2z * two
            if yielding:
                row.stretch_x, row.stretch_y = contact.stretch_x, contact.stretch_y
                row.stretch_z, row.stretch_k = contact.stretch_z, contact.stretch_k
                row.stretch_nx, row.stretch_ny = contact.stretch_nx, contact.stretch_ny
                row.stretch_nz = contact.stretch_nz
            if torsional:
                row.psi_n = contact.psi_n
            if rolling:
                one, two = contact.psi_1, contact.psi_2
                row.psi_x = contact.t1x * one + contact.t2x * two
                row.psi_y = contact.t1y * one + contact.t2y * two
                row.psi_z = contact.t1z * one + contact.t2z * two
        counters.cached = count
        counters.cached_dt = params.dt

    return kernel(store_contacts, spec)


EFFECT = Effect(
    name="warm_start",
    decide=decide,
    per="contact",
    fields=Fields(
        contact=[("matched", "i8")],  # 1 once it has taken a cached impulse
        cache=[
            ("key", "i8"),  # of the pair
            ("a", "u8"),  # bodies of the pair
            ("b", "u8"),
            ("feature", "i8"),
            ("claimed", "i8"),  # 1 once a new contact has taken the impulse
            ("rx", "f8"),  # contact point from the centre of A, world axes [m]
            ("ry", "f8"),
            ("rz", "f8"),
            ("nx", "f8"),
            ("ny", "f8"),
            ("nz", "f8"),
            ("lambda_n", "f8"),  # [N s], of a step of length counters.cached_dt
        ],
    ),
    hooks=Hooks(match=make, store=make_store),
)
