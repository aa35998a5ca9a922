"""Rotation: orientations change; something turns at the start or a contact exerts a torque."""

from collections.abc import Hashable

from ..records import ANGULAR_VELOCITY, ORIENTED_BODY
from ..terms import StepTerms
from .decision import BodyFacts, Decision, Facts, PairFacts, named
from .effect import Effect, Fields, Hooks, kernel

# Bodies of one kind are alike to all others: a pair stands for all pairs of its two kinds.
Kind = tuple[str, bool, Hashable]  # shape, whether it can move, surface


def decide(facts: Facts) -> Decision:
    """On when a body spins at the start, is twisted, or can be turned by its contacts."""
    frictional = _touched(facts, [pair for pair in facts.pairs if pair.surface.friction > 0.0])
    resisting = _touched(facts, [pair for pair in facts.pairs if pair.resists_turning])
    turned: dict[str, list[str]] = {}
    for body in facts.bodies:
        if body.movable or body.kinematic:
            why = _turned_by(body, bool(facts.pairs), frictional, resisting)
            turned.setdefault(why, []).append(body.name)
    still = turned.pop("", [])
    reasons = [f"{named(names)}: {why}" for why, names in turned.items()]
    if still:
        them = "it" if len(still) == 1 else "them"
        why = f"no contact of {them} can exert a torque" if facts.pairs else "nothing can touch"
        reasons.append(f"{named(still)} cannot turn: {why}")
    return Decision(bool(turned), "; ".join(reasons) or "nothing moves")


def _turned_by(body: BodyFacts, touches: bool, frictional: set[Kind], resisting: set[Kind]) -> str:
    """Return what turns a body, or nothing."""
    if body.spins:
        return "initial angular velocity" if body.movable else "kinematic and turning"
    if body.reoriented:
        return "an event turns it"
    if not body.movable:
        return ""
    if body.torque:
        return "a torque from the config"
    if body.twisted:
        return "a force off its centre exerts a torque"
    if touches and body.shape != "sphere":
        return "a contact off the centre of mass exerts a torque"
    if _kind(body) in frictional:
        return "friction exerts a torque"
    return "its contacts resist turning" if _kind(body) in resisting else ""


def _kind(body: BodyFacts) -> Kind:
    return body.shape, body.movable, body.name if body.config is None else body.config.surface


def _touched(facts: Facts, pairs: list[PairFacts[str]]) -> set[Kind]:
    """Return the kinds of bodies that take part in some pairs."""
    names = {name for pair in pairs for name in (pair.a, pair.b)}
    return {_kind(body) for body in facts.bodies if body.name in names}


def make(spec):
    """Return `kernel(body, velocity, dt) -> solved`: turn by omega dt; omega stays."""
    from ..rotation import turn

    def integrate_rotation(body, velocity, dt):
        wx, wy, wz = velocity.wx, velocity.wy, velocity.wz
        # What does not turn keeps its quaternion to the bit.
        if wx != 0.0 or wy != 0.0 or wz != 0.0:
            turn(body, wx * dt, wy * dt, wz * dt)
        return True

    return kernel(integrate_rotation, spec)


EFFECT = Effect(
    name="rotation",
    decide=decide,
    per="body",
    step=StepTerms(turns=True),
    fields=Fields(
        body=[*ORIENTED_BODY, ("inv_ix", "f8"), ("inv_iy", "f8"), ("inv_iz", "f8")],
        velocity=ANGULAR_VELOCITY,
    ),
    hooks=Hooks(turn=make),
)
