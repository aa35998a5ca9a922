"""What a method may spend and has spent: counted, never timed, so that equal runs are equal."""

from __future__ import annotations

# What a step of a method in numpy costs beside its factorisation [multiplications].
OVERHEAD = 500_000.0


class Account:
    """Steps and multiplications left, and the residual after each step."""

    def __init__(self, tolerance: float, steps: float, operations: float = float("inf")) -> None:
        self.tolerance = tolerance
        self.steps_left, self.operations_left = steps, operations
        self.steps = 0
        self.history: list[float] = []

    def spend(self, steps: int, operations: float, residuals: list[float]) -> None:
        """Count steps, the multiplications of all of them and the residual after each."""
        self.steps += steps
        self.steps_left -= steps
        self.operations_left -= operations
        self.history += residuals

    def step(self, operations: float, residual: float) -> None:
        """Count one step of a method in numpy."""
        self.spend(1, operations + OVERHEAD, [residual])

    @property
    def spent(self) -> bool:
        """Whether nothing is left."""
        return self.steps_left <= 0 or self.operations_left <= 0
