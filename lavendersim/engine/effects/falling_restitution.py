"""Falling restitution: what yields gives back less of a fast approach than of a slow one.

    e(v) = e_0                    up to v_y, the pair's `yield_speed`
    e(v) = e_0 (v_y / v)^(1/4)    above it
v is the approach speed by which the law of impact takes e: where impacts are at the surface that of
the two surfaces as they meet, captured that of the velocity before the solve. A contact that yields
over its whole area gives back as the -1/4th power of the speed (Johnson 1985, section 11.5, for a
sphere; cited as background, not opened); the corner at v_y, with e_0 below it, is ours. The fourth
root is two square roots, whose bits are the same on every machine. Stronge's law takes e(v) too.

Of two surfaces the weaker yields: a pair takes the smaller speed that is above 0.
"""

from __future__ import annotations

from math import sqrt

from ..spec import Spec
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Column, Effect, Fields, Hooks, Kernel, kernel
from .keys import SPEED, SurfaceKey, smaller_above_zero


def _falls(pair: PairFacts[str]) -> bool:
    return bool(pair.surface.restitution > 0.0 and pair.surface.yield_speed > 0.0)


def _described(pair: PairFacts[str]) -> str:
    speed = pair.surface.yield_speed
    return f"{pair.surface.restitution:g} falls above {speed:g} m/s" if _falls(pair) else ""


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch gives back, and less above some approach speed."""
    if any(_falls(pair) for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _described))
    return Decision(False, "no pair that may touch has restitution that falls with the speed")


def make_capture(spec: Spec) -> Kernel:
    """Return `kernel(contact, pair, params)`: what its law needs, before e is asked for."""

    def keep_yield_speed(contact, pair, params):
        contact.yield_speed, contact.e_impact = pair.yield_speed, 0.0

    return kernel(keep_yield_speed, spec)


def make_restitution_at(spec: Spec) -> Kernel:
    """Return `kernel(e, row, speed) -> e` at an approach speed [m/s]; row: of a pair or contact."""

    def restitution_at(e, row, speed):
        if row.yield_speed > 0.0 and speed > row.yield_speed:
            return e * sqrt(sqrt(row.yield_speed / speed))
        return e

    return kernel(restitution_at, spec)


def make_contact_row(spec: Spec) -> Kernel:
    """Return `kernel(out, contact, va, vb)` that fills its column of a contact."""

    def log_restitution(out, contact, va, vb):
        out.restitution = contact.e_impact

    return kernel(log_restitution, spec)


EFFECT = Effect(
    name="falling_restitution",
    decide=decide,
    per="contact",
    needs=("restitution",),
    surface_keys=(
        SurfaceKey(
            name="yield_speed",
            type=SPEED,
            default=0.0,
            doc="[m/s] approach speed above which restitution falls as its -1/4th power, 0: none; "
            "a pair takes the smaller above 0",
            mix=smaller_above_zero,
        ),
    ),
    fields=Fields(
        pair=[("yield_speed", "f8")],  # [m/s]
        contact=[
            ("yield_speed", "f8"),
            ("e_impact", "f8"),  # e at the approach speed; 0 where nothing rebounds [-]
        ],
    ),
    contact_columns=(
        Column("restitution", "f8", "coefficient at the approach speed; 0 without a rebound", "-"),
    ),
    hooks=Hooks(
        capture=make_capture, restitution_at=make_restitution_at, contact_row=make_contact_row
    ),
)
