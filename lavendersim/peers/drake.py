"""Drake: compliant contacts, one point a pair or a patch (hydroelastic), in a convex problem."""

from __future__ import annotations

from typing import Annotated, Final, Literal

from lavendersim.peers.declaration import (
    IMPULSE,
    POINT,
    TANGENTIAL,
    EngineSetting,
    Knobs,
    Peer,
    Variant,
)
from lavendersim.quantities.quantity import Quantity

_POSITIVE = Annotated[float, Quantity(above=0)]

PEER: Final = Peer(
    name="drake",
    title="Drake",
    package="drake",
    tried=("1.51.1",),
    law="compliant contacts in a convex problem, a regularised cone of friction, one point a pair "
    "of bodies or a patch; no restitution, but what its compliance gives back",
    double=True,
    variants={
        "drake": Variant(doc="Drake's own: lagged, one point a pair, 1e6 N/m, 50 s/m"),
        "drake-sap": Variant(
            doc="the convex problem of SAP, as its papers have it", settings={"model": "sap"}
        ),
        "drake-hydroelastic": Variant(
            doc="patches of pressure, 10 MPa over 5 cm: boxes stand on faces; it reports none, as "
            "a patch is no point",
            settings={"hydroelastic": True},
            reported=(),
        ),
        "drake-stiff": Variant(
            doc="1e9 N/m: penetration of micrometres, as rigid as its points may be",
            settings={"stiffness": 1e9},
        ),
    },
    settings=(
        EngineSetting(
            name="model", type=Literal["lagged", "similar", "sap"], doc="of a step's contacts"
        ),
        EngineSetting(
            name="stiffness",
            type=Annotated[float, Quantity("N/m", above=0)],
            doc="[N/m] of each body's points",
        ),
        EngineSetting(
            name="stiction_tolerance",
            type=Annotated[float, Quantity("m/s", above=0)],
            doc="[m/s] slip that counts as none",
        ),
        EngineSetting(name="hydroelastic", type=bool, doc="patches instead of points"),
        EngineSetting(name="modulus", type=_POSITIVE, doc="[Pa] of patches"),
        EngineSetting(name="dissipation", type=_POSITIVE, doc="[s/m] of Hunt and Crossley"),
    ),
    swept=(
        Knobs("drake", {"stiffness": (1e5, 1e7, 1e9)}),
        Knobs("drake"),
        Knobs("drake-sap"),
        Knobs("drake-hydroelastic", {"modulus": (1e6, 1e7, 1e8)}),
    ),
    shapes=frozenset({"plane", "sphere", "box", "capsule", "cylinder", "compound"}),
    surface_keys=frozenset({"friction"}),
    mixing={"friction": "harmonic_mean"},
    forces=True,
    reported=POINT + IMPULSE + TANGENTIAL,
    momentum=True,
    iterations="not reported by its Python",
    capacity="no limit; one point, or one patch, a pair of shapes",
    repeats="the same bits on one machine",
)
