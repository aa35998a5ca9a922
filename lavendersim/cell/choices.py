"""What a cell chooses by name: solver, sweep order, integrator, friction cone, study mistake."""

from __future__ import annotations

from typing import Final, Literal

from lavendersim.engine.solvers import SolverName

Solver = SolverName
Impacts = Literal["captured", "at_surface", "in_order"]
SimultaneousImpacts = Literal["together", "pairwise"]
Integrator = Literal["semi_implicit_euler", "midpoint", "midpoint_contact"]
ComplianceLaw = Literal["spring", "regularised"]
UndeterminedForces = Literal["least_norm", "as_solved"]
FrictionCone = Literal["disc", "pyramid", "convex"]
Order = Literal["coloured", "forward", "backward", "symmetric", "random"]
Preset = Literal["chapter", "default"]
Switch = Literal["on", "off"]
Mistake = Literal["none", "capture_in_sweeps"]
NO_MISTAKE: Final = "none"
CAPTURE_IN_SWEEPS: Final = "capture_in_sweeps"
