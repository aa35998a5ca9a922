"""Springs: a damped spring between a point of one body and a point of another.

    F = k (l - l_0) + c l',   along d, the unit vector from A's point to B's; l their distance
Where bodies move by the mean of old and new velocity, F is that of `spring_midpoint`, which keeps
the energy of springs without damping. Where they move with their new velocity each takes F at the
end of the step (implicit Euler), l followed to first order in dt along d:
    J = dt (k (l - l_0) + s v) / (1 + dt s K),   s = k dt + c
    K = 1/m_A + 1/m_B + (r_A x d) . I_A^-1 (r_A x d) + (r_B x d) . I_B^-1 (r_B x d)
v: rate of l once other forces have acted. A gets J d, B the opposite. It is stable for any k, c and
dt, and takes from the energy. Springs act after other forces; what they join does not sleep.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import Field as ModelField

from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import BodyName
from lavendersim.quantities.quantity import Quantity, Vector, Vector3

from ..records import ORIENTED_BODY
from ..spec import Spec
from ..step_terms import step_terms
from ..terms import StepTerms
from .decision import Decision, Facts, named
from .effect import Balance, Column, Effect, Fields, Hooks, Kernel, kernel
from .keys import SceneKey, TurnOf

_CENTRE: Vector3 = (0.0, 0.0, 0.0)
Point = Annotated[Vector3, Vector(3, Quantity("m"))]


class Spring(ConfigModel):
    """A damped spring between two points, each of a body."""

    a: BodyName = ModelField(description="name of a body")
    b: BodyName = ModelField(description="name of another body")
    point_a: Point = ModelField(default=_CENTRE, description="[m] in the frame of a")
    point_b: Point = ModelField(default=_CENTRE, description="[m] in the frame of b")
    stiffness: Annotated[float, Quantity("N/m", minimum=0)] = ModelField(
        description="[N/m] force per stretch"
    )
    damping: Annotated[float, Quantity("N s/m", minimum=0)] = ModelField(
        default=0.0, description="[N s/m] force per rate of length"
    )
    rest_length: Annotated[float, Quantity("m", minimum=0)] = ModelField(
        default=0.0, description="[m] length without force"
    )


def resolve(springs: tuple[Spring, ...], turn: TurnOf) -> tuple[Spring, ...]:
    """Return springs with their points in the frames of principal axes."""
    return tuple(
        one.model_copy(
            update={"point_a": turn(one.a, one.point_a), "point_b": turn(one.b, one.point_b)}
        )
        for one in springs
    )


def acts_on(scene: Any) -> Iterator[tuple[str, bool]]:
    """Yield the bodies that springs pull, and whether they turn them."""
    for one in scene.springs:
        yield one.a, any(one.point_a)
        yield one.b, any(one.point_b)


def links(scene: Any, rows: dict[str, int]) -> list[dict[str, Any]]:
    """Return the record of every spring; rows: of the bodies, by name."""
    return [
        {
            "a": rows[one.a],
            "b": rows[one.b],
            "stiffness": one.stiffness,
            "damping": one.damping,
            "rest_length": one.rest_length,
            **{f"a{axis}": value for axis, value in zip("xyz", one.point_a, strict=True)},
            **{f"b{axis}": value for axis, value in zip("xyz", one.point_b, strict=True)},
        }
        for one in scene.springs
    ]


def decide(facts: Facts) -> Decision:
    """On when a spring pulls a body that moves."""
    springs = facts.scene.springs if facts.scene is not None else ()
    movable = {body.name for body in facts.bodies if body.movable}
    pulling = [f"{one.a} and {one.b}" for one in springs if {one.a, one.b} & movable]
    if pulling:
        return Decision(True, f"{named(pulling)}: joined by a spring")
    return Decision(False, "no spring joins a body that moves")


def make_place(spec: Spec) -> Kernel:
    """Return `kernel(link, body_a, body_b) -> SpringPose`; its direction is 0 at length 0."""
    from ..spring_midpoint import SpringPose
    from ..vectors import Vec3, from_body, length, scaled

    def place(link, body_a, body_b):
        r_a = from_body(body_a, Vec3(link.ax, link.ay, link.az))
        r_b = from_body(body_b, Vec3(link.bx, link.by, link.bz))
        between = Vec3(
            body_b.x + r_b.x - body_a.x - r_a.x,
            body_b.y + r_b.y - body_a.y - r_a.y,
            body_b.z + r_b.z - body_a.z - r_a.z,
        )
        size = length(between)
        return SpringPose(size, scaled(1.0 / size if size > 0.0 else 0.0, between), r_a, r_b)

    return kernel(place, spec)


def make_act(spec: Spec) -> Kernel:
    """Return `kernel(links, bodies, velocities, motion, params, counters)`: springs act."""
    from ..rotation import inverse_inertia_times
    from ..spring_midpoint import make_act_midway
    from ..vectors import cross

    place = make_place(spec)
    if is_iterated(spec):
        return make_act_midway(spec, place)
    turns = step_terms(spec).turns

    def act(links, bodies, velocities, motion, params, counters):
        dt = params.dt
        for k in range(links.shape[0]):
            link = links[k]
            link.force, link.px, link.py, link.pz = 0.0, 0.0, 0.0, 0.0
            if link.active == 0:
                continue
            body_a, body_b = bodies[link.a], bodies[link.b]
            va, vb = velocities[link.a], velocities[link.b]
            now = place(link, body_a, body_b)
            d = now.d
            response = body_a.inv_m + body_b.inv_m
            rate = d.x * (vb.vx - va.vx) + d.y * (vb.vy - va.vy) + d.z * (vb.vz - va.vz)
            if turns:
                la, lb = cross(now.r_a, d), cross(now.r_b, d)
                tax, tay, taz = inverse_inertia_times(body_a, la.x, la.y, la.z)
                tbx, tby, tbz = inverse_inertia_times(body_b, lb.x, lb.y, lb.z)
                response += (
                    la.x * tax + la.y * tay + la.z * taz + lb.x * tbx + lb.y * tby + lb.z * tbz
                )
                rate += lb.x * vb.wx + lb.y * vb.wy + lb.z * vb.wz
                rate -= la.x * va.wx + la.y * va.wy + la.z * va.wz
            if response > 0.0:
                s = link.stiffness * dt + link.damping
                force = link.stiffness * (now.length - link.rest_length) + s * rate
                force /= 1.0 + dt * s * response
                link.force = force
                j = dt * force
                px, py, pz = j * d.x, j * d.y, j * d.z
                link.px, link.py, link.pz = px, py, pz
                va.vx += px * body_a.inv_m
                va.vy += py * body_a.inv_m
                va.vz += pz * body_a.inv_m
                vb.vx -= px * body_b.inv_m
                vb.vy -= py * body_b.inv_m
                vb.vz -= pz * body_b.inv_m
                if turns:
                    va.wx, va.wy, va.wz = va.wx + j * tax, va.wy + j * tay, va.wz + j * taz
                    vb.wx, vb.wy, vb.wz = vb.wx - j * tbx, vb.wy - j * tby, vb.wz - j * tbz

    return kernel(act, spec)


def is_iterated(spec: Spec) -> bool:
    """Whether impulses of springs are found by passes."""
    return step_terms(spec).mean_flight


def make_act_beside(spec: Spec, solve: Kernel) -> Kernel:
    """Return the kernel of springs and contacts that act on each other in a step."""
    from ..spring_contacts import make_act_beside_contacts

    return make_act_beside_contacts(spec, make_place(spec), solve)


def make_limit_projection(spec: Spec) -> Kernel:
    """Return the kernel by which the positional projection does no work on springs."""
    from ..spring_projection import make_limit_projection

    return make_limit_projection(spec, make_place(spec))


def make_step_row(spec: Spec) -> Kernel:
    """Return `kernel(row, bodies, counters)` that says how often they were not found."""
    iterated = is_iterated(spec)

    def log_not_found(row, bodies, counters):
        if iterated:
            row.spring_not_converged = counters.spring_not_converged

    return kernel(log_not_found, spec)


def make_end_part(spec: Spec) -> Kernel:
    """Return `kernel(state, params)`: impulses of a part on movable bodies from fixed ones."""

    def add_impulses(state, params):
        links, bodies = state.links, state.bodies
        for k in range(links.shape[0]):
            link = links[k]
            if link.active == 0:
                continue
            body_a, body_b = bodies[link.a], bodies[link.b]
            if body_a.inv_m > 0.0 and body_b.inv_m == 0.0:
                body_a.tied_x += link.px
                body_a.tied_y += link.py
                body_a.tied_z += link.pz
            elif body_b.inv_m > 0.0 and body_a.inv_m == 0.0:
                body_b.tied_x -= link.px
                body_b.tied_y -= link.py
                body_b.tied_z -= link.pz

    return kernel(add_impulses, spec)


def make_link_row(spec: Spec) -> Kernel:
    """Return `kernel(row, links, bodies)` that fills its columns of a step."""
    place = make_place(spec)

    def log_springs(row, links, bodies):
        energy, most, stretched = 0.0, 0.0, 0.0
        for k in range(links.shape[0]):
            link = links[k]
            if link.active == 0:
                continue
            body_a, body_b = bodies[link.a], bodies[link.b]
            stretch = place(link, body_a, body_b).length - link.rest_length
            energy += 0.5 * link.stiffness * stretch * stretch
            if abs(stretch) > abs(stretched):
                stretched = stretch
            if abs(link.force) > abs(most):
                most = link.force
        x, y, z = 0.0, 0.0, 0.0
        for i in range(bodies.shape[0]):
            body = bodies[i]
            x, y, z = x + body.tied_x, y + body.tied_y, z + body.tied_z
            body.tied_x, body.tied_y, body.tied_z = 0.0, 0.0, 0.0
        row.spring_energy, row.spring_force, row.spring_stretch = energy, most, stretched
        row.spring_impulse_x, row.spring_impulse_y, row.spring_impulse_z = x, y, z

    return kernel(log_springs, spec)


_MOVED: list[tuple[str, str]] = [
    ("joined", "i8"),  # 1: a spring pulls it
    # Impulse on it in the step so far, of springs to bodies that do not move, world [N s].
    *[(f"tied_{axis}", "f8") for axis in "xyz"],
    # Of the step: 1: springs act off its centre, 2: they say where it goes; whether its mean spin
    # is not found; its group, 1 + the first body of it, 0: none.
    *[(name, "i8") for name in ("sprung", "unturned", "group")],
    *[(f"turn_{axis}", "f8") for axis in "xyz"],  # mean spin of the step [rad/s]
    *[(f"shift_{axis}", "f8") for axis in "xyz"],  # displacement in the step [m]
    *[(f"free_w{axis}", "f8") for axis in "xyz"],  # spin before springs act [rad/s]
    *[(f"to_{kind}{axis}", "f8") for kind in "vw" for axis in "xyz"],  # velocity, spin aimed at
    *[(f"from_{axis}", "f8") for axis in ("x", "y", "z", "qw", "qx", "qy", "qz")],  # pose
    ("again", "i8"),  # 1: its springs are looked for; 2: and contacts push what they join
    ("placed", "i8"),  # 1: its velocity before contacts is that of a union which is placed
    ("worked", "i8"),  # of a union's first body, 1: surfaces do work on it or store energy
    # How much later than in the mean of the step its velocity carries and turns it: -1 to 1.
    *[("late", "f8"), ("late_turn", "f8")],
    *[(f"pulled_{axis}", "f8") for axis in "xyz"],  # change of velocity by forces alone [m/s]
    *[(f"spun_{axis}", "f8") for axis in "xyz"],  # spin before springs act, contacts left out
    *[(f"push_{axis}", "f8") for axis in "xyz"],  # what contacts add to its velocity [m/s]
    *[(f"twist_{axis}", "f8") for axis in "xyz"],  # angular impulse of contacts [N m s]
    *[(f"solved_{axis}", "f8") for axis in "xyz"],  # spin before contacts act, where it stands then
    *[(f"sprung_{axis}", "f8") for axis in "xyz"],  # change of velocity by springs [m/s]
]
_OUTER = "of springs on movable bodies from those that do not move, world"

EFFECT = Effect(
    name="spring",
    decide=decide,
    per="body",
    scene_keys=(
        SceneKey(
            name="springs",
            type=tuple[Spring, ...],
            default=(),
            doc="damped springs between points of two bodies",
            resolve=resolve,
        ),
    ),
    acts_on=acts_on,
    links=links,
    step=StepTerms(sprung=True, bounces_vary=True),
    fields=Fields(
        body=[*ORIENTED_BODY, *_MOVED],
        link=[
            ("stiffness", "f8"),  # k [N/m]
            ("damping", "f8"),  # c [N s/m]
            ("rest_length", "f8"),  # l_0 [m]
            *[(f"{end}{axis}", "f8") for end in "ab" for axis in "xyz"],  # points, body frame [m]
            ("again", "i8"),  # 1: its impulse is looked for
            ("lost", "i8"),  # 1: its impulse in this step is not found
            ("force", "f8"),  # of this step, positive where it pulls [N]
            *[(f"p{axis}", "f8") for axis in "xyz"],  # impulse on A in this step, world [N s]
            # Angular impulse on each end's body, about its centre; on B its opposite [N m s].
            *[(f"l{end}{axis}", "f8") for end in "ab" for axis in "xyz"],
        ],
    ),
    counts=("spring_not_converged",),
    step_columns=(
        Column("spring_energy", "f8", "energy that springs store", "J", number=27),
        Column("spring_impulse_x", "f8", f"impulse {_OUTER} x", "N s", number=28),
        Column("spring_impulse_y", "f8", f"impulse {_OUTER} y", "N s", number=29),
        Column("spring_impulse_z", "f8", f"impulse {_OUTER} z", "N s", number=30),
        Column("spring_force", "f8", "of the spring with the largest; it pulls", "N", number=31),
        Column("spring_stretch", "f8", "largest length less rest length", "m", number=32),
        Column(
            "spring_not_converged",
            "i8",
            "solves for the impulses of springs that took all their passes",
            number=52,
            when=is_iterated,
        ),
    ),
    balance=Balance(
        stored="spring_energy",
        outer=("spring_impulse_x", "spring_impulse_y", "spring_impulse_z"),
    ),
    hooks=Hooks(
        act_between=make_act,
        act_beside=make_act_beside,
        end_part=make_end_part,
        limit_projection=make_limit_projection,
        link_row=make_link_row,
        step_row=make_step_row,
    ),
)
