"""PhysX on the processor, through sapien: rigid contacts by small steps of Gauss-Seidel (TGS)."""

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

_SPEED = Annotated[float, Quantity("m/s", above=0)]

PEER: Final = Peer(
    name="physx",
    title="PhysX",
    package="sapien",
    tried=("3.0.3",),
    law="rigid contacts by small steps of Gauss-Seidel, patches of friction in two directions, "
    "restitution of impacts faster than a threshold",
    double=False,
    variants={
        "physx": Variant(
            doc="sapien's own: TGS, 10 position and 1 velocity iterations, no rebound below 2 m/s"
        ),
        "physx-pgs": Variant(doc="PGS, as PhysX had before TGS", settings={"tgs": False}),
        "physx-accurate": Variant(
            doc="100 position and 10 velocity iterations, bodies swept, rebounds above 0.01 m/s",
            settings={
                "iterations": 100,
                "velocity_iterations": 10,
                "swept": True,
                "bounce_threshold": 0.01,
            },
        ),
    },
    settings=(
        EngineSetting(name="tgs", type=bool, doc="small steps (TGS), else PGS"),
        EngineSetting(name="iterations", type=Count, doc="of positions"),
        EngineSetting(name="velocity_iterations", type=Count, doc="of velocities, after them"),
        EngineSetting(name="swept", type=bool, doc="continuous collision detection"),
        EngineSetting(name="bounce_threshold", type=_SPEED, doc="[m/s] of impacts that rebound"),
    ),
    swept=(
        Knobs("physx", {"iterations": (1, 10, 100)}),
        Knobs("physx-pgs", {"iterations": (10, 100)}),
        Knobs("physx-accurate"),
    ),
    own={"iterations": 10},
    shapes=frozenset({"plane", "sphere", "box", "capsule", "hull", "compound"}),
    surface_keys=frozenset({"friction", "restitution"}),
    mixing={"friction": "mean", "restitution": "mean"},
    forces=True,
    reported=POINT + IMPULSE,
    iterations="as many as are set, 10 of positions and 1 of velocities by default",
    capacity="no limit on the processor",
    repeats="the same bits on one machine",
)
