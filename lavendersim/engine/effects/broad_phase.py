"""Broad phase: a tree of bounds finds the bodies that come near, in place of all pairs."""

from ..spec import Spec
from .decision import Decision, Facts
from .effect import Effect, Fields, Hooks, Kernel

# The narrow phase's own first look at a pair costs 10 ns (spheres) to 50 ns (boxes): up to here at
# most 25 us a step, which is not worth four seconds of compiling.
MOST_PAIRS = 512


def decide(facts: Facts) -> Decision:
    """On when more pairs of bodies may touch than are worth looking at one by one."""
    if facts.pair_count > MOST_PAIRS:
        return Decision(
            True, f"{facts.pair_count} pairs of bodies may touch: only those that are near are kept"
        )
    few = "no" if facts.pair_count == 0 else f"only {facts.pair_count}"
    noun = "pair" if facts.pair_count == 1 else "pairs"
    return Decision(False, f"{few} {noun} of bodies may touch: each is looked at")


def make(spec: Spec) -> Kernel:
    """Return the kernel of the broad phase, which copies what surfaces bring to pairs."""
    from ..collide.broad.broad_phase import make as find_pairs
    from . import surface_fields

    return find_pairs(spec, surface_fields(spec))


EFFECT = Effect(
    name="broad_phase",
    decide=decide,
    per="body",
    fields=Fields(
        body=[("material", "i8")],  # row of the body's class in the table of templates
    ),
    hooks=Hooks(find_pairs=make),
)
