"""DART: rigid contacts as a boxed LCP, by Dantzig's method or by projected Gauss-Seidel."""

from __future__ import annotations

from typing import Final, Literal

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

PEER: Final = Peer(
    name="dart",
    title="DART",
    package="dartpy",
    tried=("6.20.0",),
    law="rigid contacts as a boxed LCP with a bias against penetration, a pyramid of friction in "
    "two directions, restitution of an impact",
    double=True,
    variants={
        "dart": Variant(doc="DART's own: Dantzig's method, FCL's collisions of meshes"),
        "dart-bullet": Variant(
            doc="Bullet's collisions, split impulse, 200 sweeps without a matrix: towers that "
            "Dantzig's method takes minutes a step for",
            settings={"detector": "bullet", "split_impulse": True, "sweeps": 200},
        ),
    },
    settings=(
        EngineSetting(name="detector", type=Literal["fcl", "bullet", "dart"], doc="of collisions"),
        EngineSetting(name="split_impulse", type=bool, doc="penetration beside velocities"),
        EngineSetting(name="sweeps", type=Count, doc="of Gauss-Seidel instead of Dantzig's method"),
    ),
    swept=(
        Knobs("dart"),
        Knobs("dart-bullet", {"sweeps": (10, 50, 200)}),
    ),
    shapes=frozenset({"plane", "sphere", "box"}),
    surface_keys=frozenset({"friction", "restitution"}),
    mixing={"friction": "least", "restitution": "product"},
    forces=True,
    reported=POINT + IMPULSE + TANGENTIAL,
    momentum=True,
    iterations="none by Dantzig's method, which is direct; by Gauss-Seidel at most as many as are "
    "set, it does not report how many",
    bounded=True,
    capacity="fewer than its own 1000 contacts, which its Python cannot raise: the step that has "
    "as many ends the run",
    repeats="the same bits on one machine",
)
