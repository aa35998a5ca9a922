"""Residual log: `/residuals`, the largest residual after every sweep.

Solvers then evaluate it in every sweep, and leave none out because it would change nothing.
"""

from .decision import Decision, Facts

NAME = "residual_log"
STAGE = "solve"
CHANNELS = ("/residuals",)
RESIDUAL_ROW_FIELDS = [("step", "i8"), ("sweep", "i8"), ("residual", "f8")]


def wanted(facts: Facts) -> Decision:
    """On when the config asks for the sweeps of some steps, and there are any."""
    if not facts.record:
        return Decision(False, "nothing of the run is logged")
    if not facts.residuals:
        return Decision(False, "record.residuals is none")
    if not facts.pairs:
        return Decision(False, "nothing can touch: there are no sweeps")
    return Decision(True, "record.residuals asks for the sweeps of some steps")
