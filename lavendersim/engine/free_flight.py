"""The row of a contact that a body flies past: it asks for no push."""

from __future__ import annotations

from .compile import inner

# Room [m/s, and of the velocity] that such a row leaves: round-off must not push what flies, for
# what a contact pushes is carried by the velocity of the step's end.
LOOSE = 1e-12


@inner
def target_of_flight(v_n):
    """Return the target [m/s] that holds without a push; v_n: normal velocity before the solve."""
    return -v_n + LOOSE * (1.0 + abs(v_n))
