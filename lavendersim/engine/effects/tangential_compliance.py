"""Tangential compliance: before a contact slips it gives way along its surface, as a spring does.

    F_t = -k_t s,   |F_t| <= mu F_n,   k_t = kappa k_n
s is the stretch, the way along the surface that no slip has taken; k_n the stiffness along the
normal, 1/c of a compliance, of Hertz's contact that of its depth, 3/2 k sqrt(d). kappa is the
pair's `tangential_stiffness`: of balls of one material 2 (1 - nu)/(2 - nu), k_t = 8 G* a, a the
radius of the area of contact (Mindlin 1949; cited as background, not opened). What sticks swings
with sqrt(k_t/m), m = 1/(1/m_A + 1/m_B + ...) along the surface, and slips once it is stretched by
mu F_n/k_t; a superball turns its slip round by it. Beside the spring acts a damper, where a
`tangential_damping_ratio` zeta is given: F_t = -k_t s - 2 zeta sqrt(m k_t) s'.

A step solves the law itself (`tangential_springs`): of order 2, with the energy kept while it
sticks, where bodies move by the mean of the velocities at its ends (`contact_midpoint`), of order
1, which damps, elsewhere. Where the normal is pressed further in the force is kept, where it is let
out the stretch: never is energy won. What is stretched when surfaces part is lost. Impacts of
springs that steps do not resolve (`contact_spring`) have Coulomb's friction alone, and bodies that
wake begin without a stretch. One ball that a floor carries takes 0.80 us a step in place of 0.70.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..spec import Spec
from ..terms import RowTerms
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Column, Effect, Fields, Hooks, Kernel, kernel
from .keys import COEFFICIENT, SurfaceKey, larger


def _described(pair: PairFacts[str]) -> str:
    ratio = pair.surface.tangential_stiffness
    if not (ratio > 0.0 and pair.surface.friction > 0.0 and pair.is_soft):
        return ""
    return f"{ratio:g} times as stiff along the surface as across it"


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch gives way along its surface, too."""
    if any(_described(pair) for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _described))
    return Decision(False, "no pair that may touch gives way along its surface")


def excludes(config: Any) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """Yield what is specified in vain, numerics without springs, laws of another slip."""
    surfaces = [
        (name, one)
        for name, surface in _surfaces(config)
        for one in (surface, *getattr(surface, "partners", ()))
    ]
    yielding = [name for name, one in surfaces if (one.tangential_stiffness or 0.0) > 0.0]
    if not yielding:
        return
    place = ("scene", "bodies", yielding[0], "surface", "tangential_stiffness")
    if not any((one.compliance or one.hertz_stiffness or 0.0) > 0.0 for _, one in surfaces):
        yield place, "it is by the stiffness along the normal, and all are rigid; expected 0"
    numerics = config.numerics
    if numerics.compliance_law != "spring":
        yield place, "compliance_law is regularised; expected 0, or the law spring"
    if numerics.stabilisation_gain > 0.0:
        yield place, "stabilisation_gain pushes in place of springs; expected 0, or no gain"
    if not numerics.warm_start:
        yield (
            place,
            "its stretch is kept with the impulses of warm_start; expected 0, or true there",
        )
    if config.scene.springs:
        yield place, "springs are judged by an energy without its own; expected 0 beside them"
    for name, one in surfaces:
        if (one.static_friction or 0.0) > 0.0:
            at = ("scene", "bodies", name, "surface", "static_friction")
            yield at, f"{yielding[0]} gives way along its surface, which is no slip; expected 0"
    for name, body in config.scene.bodies.items():
        if any(body.grain):
            why = f"{yielding[0]} gives way alike in all directions of its surface"
            yield ("scene", "bodies", name, "grain"), f"{why}; expected no grain"


def _surfaces(config: Any) -> Iterator[tuple[str, Any]]:
    # Of bodies, by their names, and what events give them.
    for name, body in config.scene.bodies.items():
        yield name, body.surface
    for event in config.planned_events:
        if getattr(event, "surface", None) is not None:
            yield event.body, event.surface


def make_recall(spec: Spec) -> Kernel:
    """Return `kernel(contacts, count, bodies, cache, counters, params)`."""
    from ..tangential_springs import make_recall as make

    return make(spec)


def make_yield_row(spec: Spec) -> Kernel:
    """Return `kernel(contact, pair, ma, mb, params)`."""
    from ..tangential_springs import make_yield_row as make

    return make(spec)


def make_keep_stretch(spec: Spec) -> Kernel:
    """Return `kernel(contacts, count, velocities, motion, params)`."""
    from ..tangential_springs import make_keep_stretch as make

    return make(spec)


def make_contact_row(spec: Spec) -> Kernel:
    """Return `kernel(out, contact, va, vb)` that fills its columns of a contact."""

    def log_stretch(out, contact, va, vb):
        x, y, z = contact.stretch_x, contact.stretch_y, contact.stretch_z
        out.stretch_t1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
        out.stretch_t2 = contact.t2x * x + contact.t2y * y + contact.t2z * z

    return kernel(log_stretch, spec)


EFFECT = Effect(
    name="tangential_compliance",
    decide=decide,
    per="contact",
    needs=("contact_spring", "friction", "warm_start"),
    excludes=excludes,
    row=RowTerms(shifted=True, yielding=True),
    surface_keys=(
        SurfaceKey(
            name="tangential_stiffness",
            type=COEFFICIENT,
            default=0.0,
            doc="stiffness along the surface by that along the normal, of a contact with "
            "compliance or Hertz's stiffness, 0: rigid; a pair takes the larger",
            mix=larger,
            needs="friction",
        ),
        SurfaceKey(
            name="tangential_damping_ratio",
            type=COEFFICIENT,
            default=0.0,
            doc="of critical damping along the surface, of a contact that gives way along it; "
            "a pair takes the larger",
            mix=larger,
            needs="tangential_stiffness",
        ),
    ),
    fields=Fields(
        pair=[
            ("tangential_stiffness", "f8"),  # kappa [-]
            ("tangential_damping_ratio", "f8"),  # zeta_t [-]
        ],
        contact=[
            ("surface_1", "f8"),  # added to the slip along t1 [m/s]
            ("surface_2", "f8"),
            ("gamma_t", "f8"),  # gamma of its tangents [1/kg]
            ("yield_k", "f8"),  # k_t; 0: it does not give way [N/m]
            ("yield_ratio", "f8"),  # kappa [-]
            ("yield_dt", "f8"),  # for which it touches in the step [s]
            ("yield_damping", "f8"),  # what its damper adds, by what its spring has [-]
            ("yield_1", "f8"),  # stretch that its row begins with, along t1 and t2 [m]
            ("yield_2", "f8"),
            *[(f"stretch_{axis}", "f8") for axis in "xyz"],  # world axes [m]
            *[(f"stretch_n{axis}", "f8") for axis in "xyz"],  # normal that it was across
            ("stretch_k", "f8"),  # and with which k_t; 0: there is none [N/m]
            ("recalled", "i8"),  # 1 once it has taken a stretch that was kept
        ],
        cache=[
            *[(f"stretch_{axis}", "f8") for axis in "xyz"],
            *[(f"stretch_n{axis}", "f8") for axis in "xyz"],
            ("stretch_k", "f8"),
            ("recalled", "i8"),
        ],
    ),
    contact_columns=(
        Column("stretch_t1", "f8", "way that it has given way along its surface, along t1", "m"),
        Column("stretch_t2", "f8", "way that it has given way along its surface, along t2", "m"),
    ),
    hooks=Hooks(
        recall_stretch=make_recall,
        yield_row=make_yield_row,
        keep_stretch=make_keep_stretch,
        contact_row=make_contact_row,
    ),
)
