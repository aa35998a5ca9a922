"""Warm start: contacts that persist begin at the impulse they ended with, scaled by dt/dt_cached.

A contact persists when the cache holds a point of the same pair within `cache_distance` of it, seen
from body A, whose normal still points the same way. The same feature is preferred; without one the
nearest unclaimed point serves. Rows of both lists are ordered by pair, so one walk matches all.
"""

from ..compile import kernel
from .decision import Decision, Facts

NAME = "warm_start"
STAGE = "match"
CONTACT_FIELDS = [("matched", "i8")]  # 1 once it has taken a cached impulse
CACHE_FIELDS = [
    ("pair", "i8"),
    ("feature", "i8"),
    ("claimed", "i8"),  # 1 once a new contact has taken the impulse
    ("rx", "f8"),  # contact point from the centre of A, world axes [m]
    ("ry", "f8"),
    ("rz", "f8"),
    ("nx", "f8"),
    ("ny", "f8"),
    ("nz", "f8"),
    ("lambda_n", "f8"),  # [N s], of a step of length counters.cached_dt
]


def wanted(facts: Facts) -> Decision:
    """On when the numerics ask for it and something can touch."""
    if facts.warm_start and facts.pairs:
        return Decision(True, "warm_start is true")
    return Decision(False, "nothing can touch" if facts.warm_start else "warm_start is false")


def make(spec):
    """Return `kernel(contacts, count, bodies, cache, counters, params)` that sets lambda_n."""

    def match_contacts(contacts, count, bodies, cache, counters, params):
        if counters.cached == 0:
            return
        scale = params.dt / counters.cached_dt
        nearest_allowed = params.cache_distance * params.cache_distance
        left = count
        for c in range(count):
            contacts[c].matched = 0
        # Features first, for all: a new point must not take the impulse of one that persists.
        for by_feature in (True, False):
            if left == 0:
                return
            first = 0
            for c in range(count):
                contact = contacts[c]
                if contact.matched == 1:
                    continue
                while first < counters.cached and cache[first].pair < contact.pair:
                    first += 1
                body = bodies[contact.a]
                rx, ry, rz = contact.x - body.x, contact.y - body.y, contact.z - body.z
                best, chosen = nearest_allowed, -1
                k = first
                while k < counters.cached and cache[k].pair == contact.pair:
                    old = cache[k]
                    if old.claimed == 0 and (not by_feature or old.feature == contact.feature):
                        cosine = old.nx * contact.nx + old.ny * contact.ny + old.nz * contact.nz
                        dx, dy, dz = old.rx - rx, old.ry - ry, old.rz - rz
                        distance = dx * dx + dy * dy + dz * dz
                        if cosine >= params.cache_normal_cosine and distance <= best:
                            best, chosen = distance, k
                    k += 1
                if chosen >= 0:
                    cache[chosen].claimed = 1
                    contact.matched = 1
                    contact.lambda_n = cache[chosen].lambda_n * scale
                    left -= 1

    return kernel(match_contacts, spec)


def make_store(spec):
    """Return `kernel(contacts, count, bodies, cache, counters, params)` that refills the cache."""

    def store_contacts(contacts, count, bodies, cache, counters, params):
        for c in range(count):
            contact, row = contacts[c], cache[c]
            body = bodies[contact.a]
            row.pair, row.feature, row.claimed = contact.pair, contact.feature, 0
            row.rx, row.ry, row.rz = contact.x - body.x, contact.y - body.y, contact.z - body.z
            row.nx, row.ny, row.nz = contact.nx, contact.ny, contact.nz
            row.lambda_n = contact.lambda_n
        counters.cached = count
        counters.cached_dt = params.dt

    return kernel(store_contacts, spec)
