"""Capture in the sweeps: a deliberate error, kept for teaching and for negative controls.

Restitution asks v_n >= -e v_n_pre, v_n_pre the velocity before the solve. Here every visit of the
loop asks it of the velocity that it finds,
    w = v_n + b + e min(v_n, 0)
so the first visit reverses the velocity, and the second finds nothing that approaches and takes the
bounce back: every e ends at v_n = 0, as e = 0 does. With one sweep the mistake does not show. Nor
does the residual show it: it is that of the row, in which nothing of the bounce is left.
"""

from .decision import Decision, Facts
from .effect import Choice, Effect, Fields, Hooks, kernel

STUDY_ONLY = "restitution is captured anew in every sweep, which takes the bounce back"


def decide(facts: Facts) -> Decision:
    """On when the section `study` asks for it and something bounces."""
    if facts.mistake != "capture_in_sweeps":
        return Decision(False, "restitution is captured once, before the solve")
    if any(pair.surface.restitution > 0.0 for pair in facts.pairs):
        return Decision(True, f"study-only, a deliberate error: {STUDY_ONLY}")
    return Decision(False, "asked for, but every pair that may touch has restitution 0")


def make(spec):
    """Return `kernel(contact, w, params) -> w`, with restitution of the velocity in w [m/s]."""

    def capture_again(contact, w, params):
        v_n = w - contact.target
        if -v_n > params.restitution_speed:
            w += contact.e * v_n
        return w

    return kernel(capture_again, spec)


EFFECT = Effect(
    name="capture_in_sweeps",
    decide=decide,
    per="contact",
    needs=("restitution",),
    chosen_by=Choice("mistake", "study"),
    study_only=STUDY_ONLY,
    fields=Fields(
        contact=[("e", "f8")],  # coefficient of restitution of the pair [-]
    ),
    hooks=Hooks(recapture=make),
)
