"""Mutants that no test need see, with the reason: they change no result, or only what it costs.

Of a file: the line as it is, as it is broken, and why. Where a line has changed its entry no longer
stands for anything, and a test says so (`test_mutants`).
"""

from __future__ import annotations

from tests.property.engine_mutants import ENGINE, ROOT, Mutant, applied

EXPLAINED: dict[str, tuple[tuple[str, str, str], ...]] = {}


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
