"""Logs of random contacts, as wrong as a falsified log can be."""

from __future__ import annotations

from typing import Any

import numpy as np

from lavendersim.measures.sections import Section
from lavendersim.runner.contact_sums_kernel import COLUMNS
from tests.made_cells import made_cell

BODIES = ("floor", "ball", "crate", "belt")
STEPS = 400
PLAIN = [name for name in COLUMNS if "angular" not in name and "rolling" not in name]
FORMS = {
    "frictionless": [name for name in PLAIN if "_t" not in name and "friction" not in name],
    "friction": [name for name in PLAIN if not name.startswith("torsional")],
    "spins": list(COLUMNS),
    "adhesion": [*COLUMNS, "adhesive_impulse", "an_external_column"],
}


def section(
    names: list[str],
    cone: str,
    wrong: float,
    seed: int = 0,
    integrator: str = "semi_implicit_euler",
) -> Section:
    """Return a log of random contacts, a share of whose numbers is out of all bounds."""
    random = np.random.default_rng(seed)
    counts = random.integers(0, 6, STEPS)
    counts[0] = 0
    integers = ("step", "body_a", "body_b", "joint")
    fields = [
        (name, "i8" if name in integers else "f8") for name in dict.fromkeys(("step", *names))
    ]
    rows = np.zeros(counts.sum(), fields)
    for name, kind in fields:
        if kind == "f8":
            numbers = random.normal(size=len(rows)) * 10.0 ** random.integers(-3, 3, len(rows))
            out = random.choice([np.nan, np.inf, -np.inf, 0.0, -0.0, 1e300, 5e-324], len(rows))
            rows[name] = np.where(random.random(len(rows)) < wrong, out, numbers)
    rows["step"] = np.repeat(np.arange(STEPS), counts)
    rows["body_a"], rows["body_b"] = random.integers(0, 4, (2, len(rows)))
    if "joint" in names:
        rows["joint"] = random.integers(0, 2, len(rows))
    surface = {"friction": 0.4}
    sphere = {"shape": {"kind": "sphere", "radius": 0.1}, "mass": 1.0}
    slides = {"friction": 0.2, "static_friction": 0.3, "stribeck_velocity": 0.1}
    bodies: dict[str, Any] = {
        "floor": {"shape": {"kind": "plane"}, "surface": {"friction": 0.7}},
        "ball": {**sphere, "surface": surface},
        "crate": {**sphere, "surface": slides},
        "belt": {"shape": {"kind": "box", "size": [1, 1, 1]}, "surface": surface},
    }
    numerics = {
        "friction_cone": cone,
        "integrator": integrator,
        "slop": 1e-3,
        "projection": 0.3,
    }
    config = made_cell(bodies, numerics=numerics)
    step = np.zeros(STEPS, [("step", "i8")])
    step["step"] = np.arange(STEPS)
    pose = np.zeros((STEPS, len(BODIES), 7))
    return Section(step, rows, pose, BODIES, config, config.clock, {})
