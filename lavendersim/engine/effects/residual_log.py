"""Residual log: `/residuals`, the largest residual after every sweep.

Solvers then evaluate it in every sweep, and leave none out because it would change nothing.
"""

from .decision import Decision, Facts
from .effect import Column, Effect, Hooks, kernel


def decide(facts: Facts) -> Decision:
    """On when the config asks for the sweeps of some steps, and there are any."""
    if not facts.record:
        return Decision(False, "nothing of the run is logged")
    if not facts.residuals:
        return Decision(False, "record.residuals is none")
    if not facts.pairs:
        return Decision(False, "nothing can touch: there are no sweeps")
    return Decision(True, "record.residuals asks for the sweeps of some steps")


def make_sweep_row(spec):
    """Return `kernel(params, counters, rows, sweep, residual)`: a row, where its step is asked for.

    sweep: how many are done; residual: the largest over the contacts [m/s].
    """

    def record_residual(params, counters, rows, sweep, residual):
        step = counters.step + 1
        if params.residuals_from <= step <= params.residuals_to:
            row = rows[counters.residual_rows]
            row.step, row.sweep, row.residual = step, sweep, residual
            counters.residual_rows += 1

    return kernel(record_residual, spec)


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
    hooks=Hooks(sweep_row=make_sweep_row),
)
