"""What a cell chooses by name: solver, sweep order, integrator, friction cone, study mistake."""

from __future__ import annotations

from typing import Final, Literal

Solver = Literal[
    "projected_gauss_seidel",
    "block_gauss_seidel",
    "coloured_gauss_seidel",
    "nonsmooth_conjugate_gradient",
    "jacobi",
    "accelerated_projected_gradient",
    "adaptive",
]
Impacts = Literal["captured", "at_surface"]
Integrator = Literal["semi_implicit_euler", "midpoint"]
FrictionCone = Literal["disc", "pyramid", "convex"]
Order = Literal["coloured", "forward", "backward", "symmetric", "random"]
Preset = Literal["chapter", "default"]
Switch = Literal["on", "off"]
Mistake = Literal["none", "capture_in_sweeps"]
NO_MISTAKE: Final = "none"
CAPTURE_IN_SWEEPS: Final = "capture_in_sweeps"
