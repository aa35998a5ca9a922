"""What a method may spend and has spent: counted, never timed, so that equal runs are equal.

Prices are nominal nanoseconds: what an operation took when it was measured, on one core of 2.5 GHz
or so. They are fixed, and a limit in them is a limit in seconds only roughly.
"""

from __future__ import annotations

# What a step of a method in numpy costs beside its factorisation [ns].
OVERHEAD = 500_000.0


class Account:
    """Steps and nanoseconds left, and the residual after each step."""

    def __init__(self, tolerance: float, steps: float, price: float = float("inf")) -> None:
        self.tolerance = tolerance
        self.steps_left, self.price_left = steps, price
        self.steps = 0
        self.history: list[float] = []

    def spend(self, steps: int, price: float, residuals: list[float]) -> None:
        """Count steps, the price of all of them and the residual after each."""
        self.steps += steps
        self.steps_left -= steps
        self.price_left -= price
        self.history += residuals

    def step(self, price: float, residual: float) -> None:
        """Count one step of a method in numpy."""
        self.spend(1, price + OVERHEAD, [residual])

    @property
    def spent(self) -> bool:
        """Whether nothing is left."""
        return self.steps_left <= 0 or self.price_left <= 0
