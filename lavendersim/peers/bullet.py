"""Bullet, through pybullet: rigid contacts by Gauss-Seidel, with a bias for penetration."""

from __future__ import annotations

from typing import Annotated, Final

from lavendersim.peers.declaration import (
    IMPULSE,
    POINT,
    TANGENTIAL,
    Count,
    EngineSetting,
    Knobs,
    Peer,
    Variant,
)
from lavendersim.quantities.quantity import Quantity

PEER: Final = Peer(
    name="bullet",
    title="Bullet",
    package="pybullet",
    tried=("3.2.7",),
    law="rigid contacts with a bias against penetration by Gauss-Seidel, a pyramid of friction in "
    "two directions, restitution of an impact",
    double=True,
    variants={
        "bullet": Variant(doc="pybullet's own: 50 iterations, every body a multibody"),
        "bullet-rigid": Variant(doc="plain rigid bodies, 50 iterations", settings={"rigid": True}),
        "bullet-accurate": Variant(
            doc="plain rigid bodies, 1000 iterations and no threshold: as far as its method goes",
            settings={"rigid": True, "iterations": 1000, "residual_threshold": 0.0},
        ),
    },
    settings=(
        EngineSetting(name="iterations", type=Count, doc="at most"),
        EngineSetting(
            name="residual_threshold", type=Annotated[float, Quantity(minimum=0)], doc="to stop at"
        ),
        EngineSetting(name="rigid", type=bool, doc="plain rigid bodies, no multibodies"),
    ),
    swept=(
        Knobs("bullet", {"iterations": (5, 50, 500)}),
        Knobs("bullet-rigid", {"iterations": (5, 50, 500)}),
        Knobs("bullet-accurate"),
    ),
    own={"iterations": 50},
    shapes=frozenset({"plane", "sphere", "box", "capsule", "cylinder"}),
    surface_keys=frozenset({"friction", "restitution"}),
    mixing={"friction": "product", "restitution": "product"},
    reported=POINT + IMPULSE + TANGENTIAL,
    momentum=True,
    counted=True,
    iterations="of Gauss-Seidel, in the island with the most",
    capacity="no limit, at most 4 points a pair of shapes",
    repeats="the same bits on one machine",
)
