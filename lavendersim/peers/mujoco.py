"""MuJoCo: contacts are spring-dampers in a convex problem, which Newton's method solves."""

from __future__ import annotations

from typing import Annotated, Final, Literal

from lavendersim.peers.declaration import (
    FRICTION,
    IMPULSE,
    POINT,
    TANGENTIAL,
    Count,
    EngineSetting,
    Knobs,
    Peer,
    Value,
    Variant,
)
from lavendersim.quantities.quantity import Quantity

# Bodies that start touching are apart by round-off. Where that is a contact too many or too few in
# the first step, a stiff tower of 100 is kicked and falls; this margin is more than round-off [m].
_STIFF: Final[dict[str, Value]] = {
    "cone": "elliptic",
    "tolerance": 1e-10,
    "margin": 1e-6,
    "impedance": 0.9999,
}
_STIFF_2: Final[dict[str, Value]] = _STIFF | {"time_constant_steps": 2.0}
_SHARE = Annotated[float, Quantity(above=0, below=1)]

PEER: Final = Peer(
    name="mujoco",
    title="MuJoCo",
    package="mujoco",
    tried=("4.0.0",),
    law="soft contacts in a convex problem (bodies that slide move apart); "
    "pyramid by default, cone where stiff; restitution by an underdamped spring",
    double=True,
    variants={
        "mujoco": Variant(
            doc="MuJoCo's own defaults: solref 0.02 1, solimp 0.9 0.95, pyramid, Euler"
        ),
        "mujoco-stiff": Variant(
            doc="springs of two steps, cone: least penetration", settings=_STIFF_2
        ),
        "mujoco-cg": Variant(
            doc="as stiff, conjugate gradients", settings={**_STIFF_2, "solver": "CG"}
        ),
        "mujoco-rk4": Variant(
            doc="as stiff, order 4; its contacts are those of a stage, so it reports none",
            settings={**_STIFF_2, "integrator": "RK4"},
            reported=(),
        ),
        "mujoco-discrete": Variant(
            doc="its discrete integrator, springs of a quarter step, speculative contacts",
            settings={
                **_STIFF,
                "integrator": "discrete",
                "time_constant_steps": 0.25,
                "speculative": True,
            },
        ),
    },
    settings=(
        EngineSetting(
            name="solver", type=Literal["Newton", "CG", "PGS"], doc="of the convex problem"
        ),
        EngineSetting(name="iterations", type=Count, doc="at most"),
        EngineSetting(
            name="tolerance", type=Annotated[float, Quantity(minimum=0)], doc="to stop at"
        ),
        EngineSetting(name="cone", type=Literal["pyramidal", "elliptic"], doc="of friction"),
        EngineSetting(name="integrator", type=Literal["Euler", "RK4", "discrete"], doc="of a step"),
        EngineSetting(
            name="time_constant", type=Annotated[float, Quantity("s", above=0)], doc="[s] of solref"
        ),
        EngineSetting(
            name="time_constant_steps",
            type=Annotated[float, Quantity(above=0)],
            doc="of solref, in timesteps, instead of time_constant",
        ),
        EngineSetting(
            name="damping_ratio", type=Annotated[float, Quantity(above=0)], doc="of solref"
        ),
        EngineSetting(name="impedance", type=_SHARE, doc="of solimp, at every depth"),
        EngineSetting(
            name="impratio", type=Annotated[float, Quantity(above=0)], doc="friction over normal"
        ),
        EngineSetting(name="margin", type=Annotated[float, Quantity("m", minimum=0)], doc="[m]"),
        EngineSetting(name="speculative", type=bool, doc="contacts ahead"),
        EngineSetting(name="memory", type=Count, doc="[MB] for contacts, 512 where absent"),
    ),
    swept=(
        Knobs("mujoco", {"time_constant_steps": (2.0,)}),  # as stiff as its spring may be
        Knobs("mujoco"),
        Knobs("mujoco-stiff", {"iterations": (1, 3, 100)}),
        Knobs("mujoco-cg", {"iterations": (3, 10, 100)}),
        Knobs("mujoco-rk4"),
        Knobs("mujoco-discrete"),
    ),
    shapes=frozenset(
        {"plane", "sphere", "box", "capsule", "cylinder", "ellipsoid", "hull", "compound"}
    ),
    surface_keys=frozenset({"friction", "restitution"}),
    forces=True,
    reported=POINT + IMPULSE + TANGENTIAL + FRICTION,
    momentum=True,
    counted=True,
    iterations="of the convex problem's solver, in the island with the most; by RK4 of its last "
    "stage",
    bounded=True,
    capacity="512 MB, or `memory`, for contacts and their constraints; a step that needs more ends "
    "the run",
    repeats="the same bits on one machine, in one thread",
)
