"""Packed sweeps: long solves of many bodies visit contacts eight at a time, and so does projection.

Where neighbours in the order of sweeps share no movable body, visiting eight at once is visiting
them in turn. Packed, a sweep reads what it needs of a contact and nothing else
(`solvers.packed.layout`), in a third of the time of one over the records. To round-off it is the
same sweep, in the same order, whatever contacts are made of: a normal alone, friction, torsional
and rolling friction, compliance, moving surfaces, frictionless pairs beside frictional ones.

Packing costs what two sweeps over the records save: solves of one or two sweeps, or of few
contacts, do without (`solvers.packed.late`). Below some two hundred bodies Newton's method finishes
most long solves, and sweeps are a small share of a step. From some four thousand contacts on they
are visited slab by slab, and sweeps follow each other through the scene (`slabs`).
"""

from .decision import Decision, Facts
from .effect import Effect

# Contacts of a colour, and in such colours together, from which on threads share a sweep.
SHARED_COLOUR, SHARED_SWEEP = 128, 512
# Movable bodies from which on it pays, see `tests/benchmarks/packed_sweeps.py`.
FEWEST_BODIES = 200


def decide(facts: Facts) -> Decision:
    """On where the solver is adaptive and bodies are many, by sweeps that can be packed."""
    if facts.solver != "adaptive":
        return Decision(False, f"the solver is {facts.solver}")
    movable = sum(body.movable for body in facts.bodies)
    if movable < FEWEST_BODIES:
        return Decision(False, f"{movable} movable bodies, fewer than {FEWEST_BODIES}")
    if facts.friction_cone != "disc":
        return Decision(False, f"the friction cone is {facts.friction_cone}")
    if facts.order != "coloured":
        return Decision(False, f"the order of sweeps is {facts.order}")
    if facts.over_relaxation != 1.0:
        return Decision(False, f"over_relaxation is {facts.over_relaxation:g}")
    if facts.mistake == "capture_in_sweeps":
        return Decision(False, "restitution is captured anew in every sweep")
    if any(pair.shape_pair == "joint" for pair in facts.pairs):
        return Decision(False, "rows of joints have no cone, and are not packed")
    if not facts.pairs:
        return Decision(False, "nothing can touch")
    return Decision(True, f"{movable} movable bodies have contacts enough to visit eight at a time")


EFFECT = Effect(name="packed_sweeps", decide=decide, per="contact")
