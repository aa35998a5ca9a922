"""The named sets of numerics; a config takes one by name and may change single values.

`chapter` is frozen: the checks of configs/chapter and configs/paw_check are held against it.
`default`, what a config gets that states none, is lavender's own and may become better.
"""

from __future__ import annotations

from fractions import Fraction
from types import MappingProxyType
from typing import Final

PresetValue = Fraction | float | int | bool | str | None

# Source: the contact chapter (240 Hz, 22 sweeps, warm start, captured restitution above 2 g dt,
# projection by a fifth). The chapter prints neither gain nor slop; with 0.02 and 1 mm a drop with
# e = 0.8 at 480 Hz rebounds to 0.650..0.676 m here over release phases; it prints 0.659 m.
CHAPTER: Final[dict[str, PresetValue]] = {
    "timestep": Fraction(1, 240),  # [s]
    "solver": "projected_gauss_seidel",
    "sweeps": 22,
    "over_relaxation": 1.0,
    "order": "coloured",
    "tolerance": None,  # [m/s]
    "warm_start": True,
    "stabilisation_gain": 0.02,
    "slop": 0.001,  # [m]
    "projection": 0.2,
    "projection_sweeps": 22,
    "restitution_threshold": 2.0,  # in units of g dt
    "cache_distance": 0.02,  # [m]
    "cache_normal_cosine": 0.95,
    "speculative": False,
    "impacts": "captured",
    "integrator": "semi_implicit_euler",
    "friction_cone": "disc",
    "sleeping": False,
    "sleep_speed": 0.005,  # [m/s]
    "sleep_time": 0.5,  # [s]
}

# No gain: projection alone repairs penetration, so resting repair never becomes bounce.
DEFAULT: Final[dict[str, PresetValue]] = CHAPTER | {
    "solver": "adaptive",
    "sweeps": 50,
    "tolerance": 1e-9,
    "stabilisation_gain": 0.0,
    "slop": 1e-7,
    "projection_sweeps": 20,
    "speculative": True,
    "impacts": "at_surface",
    "integrator": "midpoint",
}

PRESETS: Final = MappingProxyType({"chapter": CHAPTER, "default": DEFAULT})
