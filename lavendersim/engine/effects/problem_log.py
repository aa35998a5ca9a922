"""Problem log: what the contact problem of a step is made of, for the files that a run dumps.

    u = W r + free          `free` is of the velocities before any contact impulse acts
The solve writes impulses into the velocities it begins with, warm starts included, so these are
kept. The rest of the problem stands in the contacts when the step is over (`assemble`): where
impacts are settled by several solves, theirs is the last one's target, and its impulses.
"""

from .decision import Decision, Facts
from .effect import Effect, Hooks, kernel


def decide(facts: Facts) -> Decision:
    """On when the config asks for the contact problems of some steps, and there are any."""
    if not facts.record:
        return Decision(False, "nothing of the run is logged")
    if not facts.problems:
        return Decision(False, "record.problems is none")
    if not facts.pairs:
        return Decision(False, "nothing can touch: there are no contact problems")
    return Decision(True, "record.problems asks for the contact problems of some steps")


def make(spec):
    """Return `kernel(velocities, free)`, before the impulses that contacts start with."""

    def keep_free(velocities, free):
        for i in range(velocities.shape[0]):
            free[i] = velocities[i]

    return kernel(keep_free, spec)


EFFECT = Effect(
    name="problem_log",
    decide=decide,
    per="body",
    channels=(),  # its files stand beside the log
    hooks=Hooks(keep_free=make),
)
