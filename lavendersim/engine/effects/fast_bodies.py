"""Fast bodies: pairs that close in by much of their size in a step get contacts where they meet.

`collide.swept` finds where two such bodies meet, or pass, within the step. Planes need none of it:
their normal is the same from everywhere. A scene whose energy cannot make any two bodies that fast
is spared the search, by bounds that hold whatever the contacts do, where none gives energy:

    kinetic energy E <= E_0 + sum m |g| h        above a floor across gravity, h height over it
    sqrt(2 E) <= sqrt(2 E_0) + |g| T sqrt(sum m)    falling for all the time T: gravity's power is
                                                 at most |g| sum m |v| <= |g| sqrt(sum m) sqrt(2 E)
    |v_A - v_B| <= sqrt(2 E (1/m_A + 1/m_B))     with all of it in two bodies

What may give energy besides gravity (`_source_of_energy`) leaves no bound. Restitution captured at
the start of a step does: up to m |g| dt times the speed in every bounce (`measures.balance`).
"""

from math import hypot, inf, sqrt

from ..records import CAVITIES
from ..terms import RowTerms
from .decision import BodyFacts, Decision, Facts, meeting
from .effect import Column, Effect, Fields, Hooks, kernel

# Share of the smaller bounding radius that a pair may close in a step before it is fast [-].
FAST = 0.5
# The bound on speeds is taken this many times, for what a solver's error may add to them [-].
SAFETY = 1.5
# A floor is across gravity when the cosine between them is 1 to so much [-].
LEVEL = 1e-9
# Where a step leads into these is seen from where it begins.
UNSWEPT = CAVITIES | {"plane"}


def decide(facts: Facts) -> Decision:
    """On when two bodies without a plane between them may come to close in fast."""
    if not facts.speculative:
        return Decision(False, "speculative is false")
    bodies = {body.name: body for body in facts.bodies}
    between = [
        pair
        for pair in meeting(facts)
        if UNSWEPT.isdisjoint((bodies[pair.a].shape, bodies[pair.b].shape))
    ]
    if not between:
        if any(body.shape in CAVITIES for body in facts.bodies):
            return Decision(False, "only planes and cavities can be run into, from one side")
        return Decision(False, "only planes can be run into, and their normal is everywhere alike")
    source = _source_of_energy(facts)
    if source:
        return Decision(True, f"{source}: no bound on how fast {between[0].a} may become")
    farthest = facts.timestep * SAFETY * _closing_speed(facts)
    smallest = min(body.least_size for body in facts.bodies)
    allowed = FAST * smallest
    if farthest > allowed:
        return Decision(
            True,
            f"the energy there is could move bodies {farthest:.2g} m in a step, {allowed:.2g} m is"
            " far for the smallest",
        )
    return Decision(
        False,
        f"the energy there is moves no body {farthest:.2g} m in a step, {allowed:.2g} m would be"
        " far for the smallest",
    )


def _source_of_energy(facts: Facts) -> str:
    """Return what may give energy besides gravity, in words; nothing where nothing does."""
    for body in facts.bodies:
        if body.force or body.torque:
            return f"a force or torque acts on {body.name}"
        if body.pulled:
            return f"a force between bodies acts on {body.name}"
        if body.kinematic and (body.spins or body.speed > 0.0):
            return f"{body.name} moves as its velocity says"
        if any(one is not None and any(one.surface_velocity) for one in body.forms):
            return f"the surface of {body.name} moves"
    if facts.events:
        return "events change bodies"
    if facts.later_gravity:
        return "events change gravity"
    if facts.stabilisation_gain > 0.0:
        return "stabilisation pushes bodies apart"
    for pair in facts.pairs:
        if pair.is_soft:
            return f"{pair.a} and {pair.b} are springs"
        if pair.surface.restitution > 0.0 and facts.impacts == "captured":
            return f"{pair.a} and {pair.b} bounce from where a step begins, above the surface"
    return ""


def _closing_speed(facts: Facts) -> float:
    """Return the greatest speed relative to each other that two bodies may reach [m/s]."""
    movable = [body for body in facts.bodies if body.movable]
    masses = [body.config.mass for body in movable]
    g = hypot(*facts.gravity)
    energy = sum(_kinetic_energy(body) for body in movable)
    falling = sqrt(2.0 * energy) + g * facts.duration * sqrt(sum(masses))
    bound = 0.5 * falling * falling
    floor = _floor(facts, g)
    if floor > -inf:
        fx, fy, fz = facts.gravity
        fall = 0.0
        for body, mass in zip(movable, masses, strict=True):
            x, y, z = body.config.position
            height = -(fx * x + fy * y + fz * z) / g - floor
            fall += mass * g * max(height + body.size, 0.0)
        bound = min(bound, energy + fall)
    lightest = sorted(masses)[:2]
    return sqrt(2.0 * bound * sum(1.0 / mass for mass in lightest))


def _floor(facts: Facts, g: float) -> float:
    """Return the height against gravity of the highest plane that lies across it [m], or -inf."""
    if g == 0.0:
        return -inf
    heights = [-inf]
    for body in facts.bodies:
        if body.shape == "plane":
            shape = body.config.shape
            upward = -sum(n * f for n, f in zip(shape.normal, facts.gravity, strict=True)) / g
            if upward >= 1.0 - LEVEL:
                heights.append(shape.offset)
    return max(heights)


def _kinetic_energy(body: BodyFacts) -> float:
    """Return the largest kinetic energy that the config gives a body [J]."""
    mass, spin = float(body.config.mass), hypot(*body.config.angular_velocity)
    inertia = float(max(body.config.inertia))
    # a power raises where this is infinite
    return 0.5 * mass * (body.speed * body.speed) + 0.5 * inertia * (spin * spin)


def make_step_row(spec):
    """Return `kernel(row, bodies, counters)` that says how often no meeting was found."""

    def log_not_found(row, bodies, counters):
        row.advance_not_converged = counters.advance_not_converged

    return kernel(log_not_found, spec)


EFFECT = Effect(
    name="fast_bodies",
    decide=decide,
    per="body",
    needs=("speculative",),
    row=RowTerms(swept=True),
    fields=Fields(
        contact=[
            # displacement of B from A across n until the impact [m]
            ("tangential_x", "f8"),
            ("tangential_y", "f8"),
            ("tangential_z", "f8"),
        ],
    ),
    counts=("advance_not_converged",),
    step_columns=(
        Column(
            "advance_not_converged",
            "i8",
            "meetings of fast bodies for which conservative advancement took all its iterations",
            number=48,
        ),
    ),
    hooks=Hooks(step_row=make_step_row),
)
