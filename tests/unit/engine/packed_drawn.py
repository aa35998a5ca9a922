"""Contact problems with rows of every kind, drawn at random, for solvers that pack contacts."""

from __future__ import annotations

from functools import cache

import numpy as np
from laboratory import EVERYTHING, Bench, box, plane, resolved, sphere

from lavendersim.engine.effects import EFFECTS
from lavendersim.engine.solvers.packed.layout import allocate_packed
from lavendersim.engine.solvers.packed.sweep import make_packed_iteration
from lavendersim.engine.solvers.solver import Solver
from lavendersim.engine.spec import Spec
from tests.benchmarks.prepared_contacts import Prepared, next_step

GRAVITY = (0.0, 0.0, -9.81)
EVERY_ROW = EVERYTHING.without("residual_log")
TOWERS = 17  # of two boxes and a ball: nine contacts each


def with_rows(*terms: str) -> Spec:
    """Return an engine whose rows have these terms (`RowTerms`) of all that there are."""
    optional = {"frictional", "frictionless", "compliant", "torsional", "rolling", "levers"}
    left_out = optional - set(terms) | (set() if "shifted" in terms else {"shifted"})
    return EVERY_ROW.without(
        *(effect.name for effect in EFFECTS if any(getattr(effect.row, term) for term in left_out))
    )


def _surface(draw: np.random.Generator, frictional: bool) -> dict[str, float]:
    """Return a surface: each property with even odds absent, some surfaces without any."""
    sizes = {
        "friction": draw.uniform(0.1, 0.9),
        "torsional_friction": draw.uniform(1e-3, 0.02),
        "rolling_friction": draw.uniform(1e-3, 0.02),
        "compliance": draw.uniform(1e-7, 1e-5),
    }
    plain = not frictional or draw.random() < 0.25
    names = ("compliance",) if plain else sizes
    return {name: float(sizes[name] * (draw.random() < 0.5)) for name in names}


def _body(
    draw: np.random.Generator, shape: str, place: tuple, frictional: bool, turns: bool
) -> dict:
    # Some are all but at rest: their contacts stay inside their limits.
    speed = 1.0 if draw.random() < 0.5 else 1e-3
    state = {
        "mass": float(draw.uniform(0.5, 5.0)),
        "velocity": tuple(speed * draw.uniform(-1.0, 1.0, 3) * (1.0, 1.0, 0.2)),
        "angular_velocity": tuple(speed * turns * draw.uniform(-5.0, 5.0, 3)),
    }
    surface = _surface(draw, frictional)
    if shape == "sphere":
        return sphere(0.1, place, **state, **surface)
    return box((0.3, 0.25, 0.2), place, **state, **surface)


@cache
def drawn(seed: int, frictional: bool = True, round_only: bool = False) -> Prepared:
    """Return what a solver finds in the third step of towers on belts and on the floor.

    frictional: some surfaces have friction. round_only: of balls alone, three towers for each.
    """
    draw = np.random.default_rng(seed)
    # The floor under every tower: its pairs are of every kind by the towers' surfaces.
    bodies = {"floor": plane()}
    if frictional:
        bodies["belt"] = box(
            (40.0, 0.5, 0.2), (0.0, 3.0, -0.1), fixed=True, friction=0.7,
            surface_velocity=(0.4, -0.1, 0.0),
        )  # fmt: skip
        bodies["floor"] = plane(friction=0.2, rolling_friction=2e-3)
    for t in range(TOWERS * (3 if round_only else 1)):
        y = 3.0 if frictional and t % 3 == 0 else 0.0
        height = 0.0
        for k, shape in enumerate(("sphere",) * 3 if round_only else ("box", "box", "sphere")):
            half = 0.1
            place = (0.5 * t - 4.0, y, height + half - 1e-3 * (k + 1))
            # A ball on a box rests on few faces of it: the box below stays level in three steps.
            bodies[f"{shape}_{t}_{k}"] = _body(draw, shape, place, frictional, not round_only)
            height += 2.0 * half
    cell = resolved(bodies, GRAVITY, stabilisation_gain=0.02, slop=1e-4)
    bench = Bench(cell)
    bench.run(2)
    return next_step(bench.engine, EVERY_ROW)


def packed_solver(eight: bool) -> Solver:
    """Return sweeps over packed contacts from the first on, of any rows; one at a time or eight."""
    return Solver(
        name=f"packed_{'eights' if eight else 'singly'}",
        iteration=lambda spec: make_packed_iteration(spec, eight),
        allocate=lambda spec, bodies, contacts: allocate_packed(spec, bodies, contacts, eight),
    )
