"""Static friction: what sticks holds more than what slides; Stribeck's velocity lies between.

    mu(v) = mu_k + (mu_s - mu_k) / (1 + (v / v_s)^2)
v is the slip speed; mu_k the pair's `friction`, mu_s its `static_friction`, v_s its
`stribeck_velocity`, at which half of the difference is left. The falling coefficient is Stribeck's,
the algebraic form that of Hess and Soom (1990; cited as background, not opened): no exponential,
whose last bit differs between machines. Each step solves Coulomb's law with one coefficient, so no
solver knows of it. It is that of the slip at which the step begins, before forces act (lagged), and
the motion of what slides of first order in the timestep; what rests holds up to mu_s at any.

Where contacts are solved at the middle of the step (`contact_midpoint`) v is the mean of the slips
at both its ends, the implicit midpoint rule, and the motion of order 2: passes find it. A pass
leaves k_t lambda_n |dmu/dv|/2 of what the last was off by. Where the friction that falls changes
the slip of a step by less than v_s/2 that is below a fifth, as |dmu/dv| < 0.65 (mu_s - mu_k)/v_s;
elsewhere the step does not resolve the curve, and v is that of its start. So it is beyond v_s/4.

A pair's static coefficient is the geometric mean of its surfaces', as the kinetic one is. Without
kinetic friction a contact has no tangents to hold it by: a surface with the one alone is refused.
"""

from math import sqrt
from typing import Annotated, Any

from lavendersim.quantities.quantity import Quantity

from ..spec import Spec
from ..step_terms import step_terms
from ..terms import RowTerms
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Balance, Effect, Fields, Hooks, Kernel, kernel
from .keys import COEFFICIENT, SurfaceKey, geometric_mean, larger

# How far the slip of the middle may be from that of the start, in Stribeck velocities.
RESOLVED = 0.25


def _is_static(pair: PairFacts[str]) -> bool:
    return bool(0.0 < pair.surface.friction < pair.surface.static_friction)


def _reason(pair: PairFacts[str]) -> str:
    if not _is_static(pair):
        return ""
    at_rest, speed = pair.surface.static_friction, pair.surface.stribeck_velocity
    return f"{at_rest:g} at rest, {pair.surface.friction:g} well above {speed:g} m/s"


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch has more friction at rest than while it slides."""
    if any(_is_static(pair) for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _reason))
    return Decision(False, "no pair that may touch has friction and more of it at rest")


def make_start_step(spec: Spec) -> Kernel:
    """Return `kernel(bodies, velocities)`: keep the velocities that a step begins with."""

    def keep_start(bodies, velocities):
        for i in range(bodies.shape[0]):
            v = velocities[i]
            v.start_vx, v.start_vy, v.start_vz = v.vx, v.vy, v.vz
            v.start_wx, v.start_wy, v.start_wz = v.wx, v.wy, v.wz
            v.mean_vx, v.mean_vy, v.mean_vz = v.vx, v.vy, v.vz
            v.mean_wx, v.mean_wy, v.mean_wz = v.wx, v.wy, v.wz

    return kernel(keep_start, spec)


def _make_slip(spec: Spec) -> Kernel:
    """Return `kernel(contact, a, turn_a, b, turn_b) -> (s_1, s_2)`, of two moving bodies [m/s]."""
    from ..row_terms import row_terms
    from . import has_hook

    moving_surface, coupled = has_hook(spec, "surface_velocity"), row_terms(spec).coupled

    def slip(contact, a, turn_a, b, turn_b):
        x = (
            b.x + turn_b.y * contact.rbz - turn_b.z * contact.rby
            - a.x - turn_a.y * contact.raz + turn_a.z * contact.ray
        )  # fmt: skip
        y = (
            b.y + turn_b.z * contact.rbx - turn_b.x * contact.rbz
            - a.y - turn_a.z * contact.rax + turn_a.x * contact.raz
        )  # fmt: skip
        z = (
            b.z + turn_b.x * contact.rby - turn_b.y * contact.rbx
            - a.z - turn_a.x * contact.ray + turn_a.y * contact.rax
        )  # fmt: skip
        if coupled:
            spin = contact.nx * (turn_b.x - turn_a.x)
            spin += contact.ny * (turn_b.y - turn_a.y)
            spin += contact.nz * (turn_b.z - turn_a.z)
            x += spin * contact.patch_x
            y += spin * contact.patch_y
            z += spin * contact.patch_z
        s_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
        s_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
        if moving_surface:
            s_1 += contact.surface_1
            s_2 += contact.surface_2
        return s_1, s_2

    return kernel(slip, spec)


def _make_slip_at_start(spec: Spec, slip: Kernel) -> Kernel:
    """Return `kernel(contact, va, vb) -> (s_1, s_2)` as the step began [m/s]; slip: see above."""
    from ..vectors import Vec3

    def slip_at_start(contact, va, vb):
        return slip(
            contact,
            Vec3(va.start_vx, va.start_vy, va.start_vz),
            Vec3(va.start_wx, va.start_wy, va.start_wz),
            Vec3(vb.start_vx, vb.start_vy, vb.start_vz),
            Vec3(vb.start_wx, vb.start_wy, vb.start_wz),
        )

    return kernel(slip_at_start, spec)


def _make_coefficient(spec: Spec) -> Kernel:
    """Return `kernel(contact, pair, s_1, s_2) -> mu` of a slip along the tangents [m/s]."""
    from ..row_terms import row_terms

    stretched = row_terms(spec).stretched

    def coefficient(contact, pair, s_1, s_2):
        squared = s_1 * s_1 + s_2 * s_2
        if stretched:
            squared = s_1 * s_1 * contact.ease_1 + s_2 * s_2 * contact.ease_2
        ratio = squared / (pair.stribeck_velocity * pair.stribeck_velocity)
        return pair.friction + (pair.static_friction - pair.friction) / (1.0 + ratio)

    return kernel(coefficient, spec)


def _make_resolves(spec: Spec) -> Kernel:
    """Return `kernel(contact, pair, impulse) -> whether` a step resolves how friction falls.

    impulse: along the normal [N s].
    """

    def resolves(contact, pair, impulse):
        falls = impulse * contact.k_t * (pair.static_friction - pair.friction)
        return falls <= 2.0 * RESOLVED * pair.stribeck_velocity

    return kernel(resolves, spec)


def make_prepare(spec: Spec) -> Kernel:
    """Return `kernel(contact, va, vb, pair, params)`: mu at the slip of the step."""
    from ..vectors import Vec3

    slip, coefficient = _make_slip(spec), _make_coefficient(spec)
    slip_at_start = _make_slip_at_start(spec, slip)
    centred = step_terms(spec).centred
    resolves: Any = _make_resolves(spec) if centred else None

    def set_friction(contact, va, vb, pair, params):
        if pair.static_friction > pair.friction and pair.friction > 0.0:
            s_1, s_2 = slip_at_start(contact, va, vb)
            midway = False
            if centred:
                midway = resolves(contact, pair, contact.kept_n)
            if midway:
                one, two = slip(
                    contact,
                    Vec3(va.mean_vx, va.mean_vy, va.mean_vz),
                    Vec3(va.mean_wx, va.mean_wy, va.mean_wz),
                    Vec3(vb.mean_vx, vb.mean_vy, vb.mean_vz),
                    Vec3(vb.mean_wx, vb.mean_wy, vb.mean_wz),
                )
                one, two = one - s_1, two - s_2
                change, most = sqrt(one * one + two * two), RESOLVED * pair.stribeck_velocity
                share = most / change if change > most else 1.0
                s_1, s_2 = s_1 + share * one, s_2 + share * two
            contact.mu = coefficient(contact, pair, s_1, s_2)

    return kernel(set_friction, spec)


def make_differs_midway(spec: Spec) -> Kernel:
    """Return `kernel(state, count, params) -> whether` a solve at the middle has another mu.

    Once the start of the step is solved: of what slides, where the step resolves the change.
    """
    from ..midpoint_rows import SAME
    from ..vectors import Vec3

    slip, coefficient = _make_slip(spec), _make_coefficient(spec)
    slip_at_start = _make_slip_at_start(spec, slip)
    resolves = _make_resolves(spec)

    def differs_midway(state, count, params):
        for c in range(count):
            contact, pair = state.contacts[c], state.pairs[state.contacts[c].pair]
            falls = pair.static_friction > pair.friction and pair.friction > 0.0
            if not falls or contact.lasts == 0 or contact.lambda_n == 0.0:
                continue
            if not resolves(contact, pair, contact.lambda_n):
                continue
            va, vb = state.velocities[contact.a], state.velocities[contact.b]
            s_1, s_2 = slip_at_start(contact, va, vb)
            one, two = slip(
                contact,
                Vec3(va.vx, va.vy, va.vz),
                Vec3(va.wx, va.wy, va.wz),
                Vec3(vb.vx, vb.vy, vb.vz),
                Vec3(vb.wx, vb.wy, vb.wz),
            )
            one, two = 0.5 * (one - s_1), 0.5 * (two - s_2)
            if sqrt(one * one + two * two) <= RESOLVED * pair.stribeck_velocity:
                mu = coefficient(contact, pair, s_1 + one, s_2 + two)
                if abs(mu - contact.mu) * contact.lambda_n * contact.k_t > SAME:
                    return True
        return False

    return kernel(differs_midway, spec)


def make_note_middle(spec: Spec) -> Kernel:
    """Return `kernel(bodies, velocities, lead, midway, params) -> 0`: keep means of both ends.

    velocities: at its end, as far as they are known; lead: at its start, spins turned to the
    middle. midway: or else those of its start. 0: rows miss what the coefficient changes.
    """

    def keep_mean(bodies, velocities, lead, midway, params):
        for i in range(velocities.shape[0]):
            v, m = velocities[i], lead[i]
            if not midway:
                v.mean_vx, v.mean_vy, v.mean_vz = v.start_vx, v.start_vy, v.start_vz
                v.mean_wx, v.mean_wy, v.mean_wz = v.start_wx, v.start_wy, v.start_wz
                continue
            v.mean_vx, v.mean_vy = 0.5 * (m.vx + v.vx), 0.5 * (m.vy + v.vy)
            v.mean_vz = 0.5 * (m.vz + v.vz)
            v.mean_wx, v.mean_wy = 0.5 * (m.wx + v.wx), 0.5 * (m.wy + v.wy)
            v.mean_wz = 0.5 * (m.wz + v.wz)
        return 0.0

    return kernel(keep_mean, spec)


EFFECT = Effect(
    name="static_friction",
    decide=decide,
    per="contact",
    needs=("friction",),
    surface_keys=(
        SurfaceKey(
            name="static_friction",
            type=COEFFICIENT,
            default=0.0,
            doc="coefficient at rest, where above `friction`, which must then be above 0 as well; "
            "a pair takes the geometric mean",
            mix=geometric_mean,
            needs="friction",
        ),
        SurfaceKey(
            name="stribeck_velocity",
            type=Annotated[float, Quantity("m/s", above=0)],
            default=0.001,
            doc="[m/s] slip at which half of what static friction adds is left; the larger of two",
            mix=larger,
        ),
    ),
    fields=Fields(
        velocity=[  # as the step begins, and the means of both ends [m/s], [rad/s]
            (f"{when}_{k}{axis}", "f8")
            for when in ("start", "mean")
            for k in "vw"
            for axis in "xyz"
        ],
        pair=[("static_friction", "f8"), ("stribeck_velocity", "f8")],  # [-], [m/s]
    ),
    row=RowTerms(varied=True),
    balance=Balance(varies_friction="static_friction"),
    hooks=Hooks(
        start_step=make_start_step,
        prepare=make_prepare,
        differs_midway=make_differs_midway,
        note_middle=make_note_middle,
    ),
)
