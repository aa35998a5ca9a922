"""The budget of a search in steps and nominal nanoseconds: counted, never timed.

So equal runs are equal. A nominal cost is what an operation took when it was measured, on one core
of 2.5 GHz or so. It is fixed, and a limit in it is a limit in seconds only roughly.
"""

from __future__ import annotations

# Cost of a step of a method in numpy beside its factorisation [ns].
STEP_OVERHEAD = 500_000.0


class Budget:
    """Steps and nanoseconds left, and the residual after each step."""

    def __init__(self, tolerance: float, steps: float, cost: float = float("inf")) -> None:
        self.tolerance = tolerance
        self.steps_left, self.cost_left = steps, cost
        self.steps = 0
        self.history: list[float] = []

    def spend(self, steps: int, cost: float, residuals: list[float]) -> None:
        """Count steps, the cost of all of them and the residual after each."""
        self.steps += steps
        self.steps_left -= steps
        self.cost_left -= cost
        self.history += residuals

    def step(self, cost: float, residual: float) -> None:
        """Count one step of a method in numpy."""
        self.spend(1, cost + STEP_OVERHEAD, [residual])

    @property
    def spent(self) -> bool:
        """Whether nothing is left."""
        return self.steps_left <= 0 or self.cost_left <= 0
