"""Supernodes: the matrix of Newton's method over many bodies, in an order that fills it less.

An envelope (`solvers.newton.envelope`) is what it takes for a tower or a small heap. Its rows grow
with the breadth of a scene, a wide pile's to hundreds of bodies, each of which touches five. By
minimum degree bodies are eliminated where they tie together the fewest others, and those that are
tied alike form supernodes, whose rows are dense (`solvers.newton.panels`). Which of the two a
contact graph gets follows from counted operations; an order is kept while the graph stands.

What stands is solved once, and a sweep a step keeps it. A heap with bodies that touch in single
points is solved anew in every step: thirty in which a thousand spheres land all to 1e-9 m/s instead
of 1e-2, in a hundred times the time of the sweeps (`tests/benchmarks/large_scenes.py`). That is for
configs that ask for it, by `effects: {supernodes: on}`. Where a factor takes more than some 12,000
multiplications a contact, as that of a settled heap of a thousand does, or more than four million
entries, solves are left to sweeps all the same, and `/step` counts what was not solved.
"""

from __future__ import annotations

from . import newton
from .decision import Decision, Facts
from .effect import Effect

# Movable bodies from which on an envelope may be more than an order is worth finding for.
FEWEST_BODIES = 200


def decide(facts: Facts) -> Decision:
    """On where bodies are many and Newton's method may be required."""
    movable = sum(body.movable for body in facts.bodies)
    if movable < FEWEST_BODIES:
        return Decision(False, f"{movable} movable bodies, fewer than {FEWEST_BODIES}")
    if not newton.decide(facts).on:
        return Decision(False, "no solve is finished by Newton's method")
    if any(body.shape in newton.ONE_POINT for body in facts.bodies if body.movable):
        return Decision(False, "heaps of bodies that touch in single points are left to sweeps")
    return Decision(True, f"the factor of {movable} bodies may fill less in another order")


EFFECT = Effect(name="supernodes", decide=decide, per="contact", needs=("newton",))
