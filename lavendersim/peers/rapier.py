"""Rapier: rigid contacts with soft constraints, by small steps of Gauss-Seidel."""

from __future__ import annotations

from typing import Annotated, Final

from lavendersim.peers.declaration import (
    IMPULSE,
    POINT,
    Count,
    EngineSetting,
    Knobs,
    Peer,
    Variant,
)
from lavendersim.quantities.quantity import Quantity

_LENGTH = Annotated[float, Quantity("m", above=0)]

PEER: Final = Peer(
    name="rapier",
    title="Rapier",
    package="rapier3d",
    tried=("0.36.1",),
    law="soft constraints by Gauss-Seidel over small steps, Newton's law of restitution",
    double=False,
    variants={
        "rapier": Variant(doc="Rapier's own: 4 iterations, 30 Hz contact softness, 5 mm allowed"),
        "rapier-stiff": Variant(
            doc="least drift and overlap of towers at a cost near that of its own settings",
            settings={
                "iterations": 8,
                "internal_iterations": 4,
                "allowed_error": 1e-5,
                "stiff_steps": 2.0,
                "swept": True,
            },
        ),
    },
    settings=(
        EngineSetting(name="iterations", type=Count, doc="of the solver, each a small step"),
        EngineSetting(name="internal_iterations", type=Count, doc="sweeps of each"),
        EngineSetting(name="allowed_error", type=_LENGTH, doc="[m] penetration left alone"),
        EngineSetting(
            name="stiff_steps",
            type=Annotated[float, Quantity(above=0)],
            doc="natural frequency of contact springs times the timestep; damping ratio 5",
        ),
        EngineSetting(name="swept", type=bool, doc="continuous collision detection"),
    ),
    swept=(
        Knobs("rapier", {"iterations": (1, 4, 16)}),
        Knobs("rapier-stiff", {"iterations": (4, 8, 32)}),
    ),
    own={"iterations": 4},
    shapes=frozenset({"plane", "sphere", "box"}),
    surface_keys=frozenset({"friction", "restitution"}),
    mixing={"friction": "product", "restitution": "larger"},
    forces=True,
    reported=POINT + IMPULSE,
    iterations="as many as are set, 4 small steps by default",
    capacity="no limit",
    repeats="the same bits on one machine, in one thread",
)
