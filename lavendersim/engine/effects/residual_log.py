"""Residual log: `/residuals`, the largest residual after every sweep.

Solvers then evaluate it in every sweep, and leave none out because it would change nothing.
"""

from .decision import Decision, Facts
from .effect import Column, Effect


def decide(facts: Facts) -> Decision:
    """On when the config asks for the sweeps of some steps, and there are any."""
    if not facts.record:
        return Decision(False, "nothing of the run is logged")
    if not facts.residuals:
        return Decision(False, "record.residuals is none")
    if not facts.pairs:
        return Decision(False, "nothing can touch: there are no sweeps")
    return Decision(True, "record.residuals asks for the sweeps of some steps")


EFFECT = Effect(
    name="residual_log",
    decide=decide,
    per="contact",
    residual_columns=(
        Column("step", "i8", "index of the step"),
        Column("sweep", "i8", "sweeps done; 0 is before the first", number=1),
        Column("residual", "f8", "largest residual over the contacts", "m/s", number=2),
    ),
    channels=("/residuals",),
)
