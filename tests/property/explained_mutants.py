"""Mutants that no test need see, with the reason: they change no result, or only what it costs.

Of a file: the line as it is, as it is broken, and why. Where a line has changed its entry no longer
stands for anything, and a test says so (`test_mutants`).
"""

from __future__ import annotations

from tests.property.engine_mutants import ENGINE, ROOT, Mutant, applied

EXPLAINED: dict[str, tuple[tuple[str, str, str], ...]] = {
    "collide/manifold/line_normal.py": (
        (
            "d = minus(d, position(scratch.outline_a.corners[0]))",
            "d = minus(d, position(scratch.outline_a.corners[1]))",
            "no result: of d only what is across the edge is used, which both its ends share",
        ),
    ),
    "solvers/newton/method.py": (
        (
            "lightest = 1.0 / contacts[0].k_n",
            "lightest = 1.0 * contacts[0].k_n",
            "cost: the loop takes the least of all 1/k; one below it ends rounds more exactly",
        ),
        (
            "stalled, columns = 0, NO_ROUND",
            "stalled, columns = 1, NO_ROUND",
            "cost: shifts are brought on together a round sooner; where rounds end is the law's",
        ),
    ),
    "spring_midpoint.py": (
        (
            "change = plus(scaled(along, d), scaled(1.0 / (1.0 + max(stiff, 0.0)), across))",
            "change = plus(scaled(along, d), scaled(1.0 / (2.0 + max(stiff, 0.0)), across))",
            "cost: how far a step goes; passes end where nothing is missing, or say that it is",
        ),
        (
            "body.turn_x, body.turn_y = 0.5 * (m.wx + v.wx), 0.5 * (m.wy + v.wy)",
            "body.turn_x, body.turn_y = 0.5 * (m.wx + v.wy), 0.5 * (m.wy + v.wy)",
            "cost: where Newton's method for the mean spin begins, which ends at the same spin",
        ),
    ),
}


def change_of(mutant: Mutant, text: str) -> tuple[str, str]:
    """Return a mutant's line as it is, and as it is broken."""
    broken = applied(text, mutant)
    return text.splitlines()[mutant.line - 1].strip(), broken.splitlines()[mutant.line - 1].strip()


def explained(mutant: Mutant) -> str:
    """Return why no test need see a mutant; nothing where none is known."""
    if mutant.file not in EXPLAINED:
        return ""
    change = change_of(mutant, (ROOT / ENGINE / mutant.file).read_text())
    return next((why for *known, why in EXPLAINED[mutant.file] if tuple(known) == change), "")
