"""The matrix of cases and solvers as one self-contained HTML page.

An entry shows its verdict by sign and colour, by words when pointed at, and links to its log; what
failed is listed again below, solver by solver, for a page that is printed or has no pointer.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

from lavendersim.durable_files import write_whole
from lavendersim.figures.html_page import address, count_of, picture, render


class Matrix(NamedTuple):
    """What the page is made of."""

    cases: Sequence[Any]  # .name `family/case`, .question, .reduced
    solvers: Sequence[str]
    entries: Sequence[Any]  # .case, .solver, .verdict, .why, .detail, .margin, .number, .claim, ...
    left_out: Mapping[str, str]  # config -> why it is no case
    shown: Mapping[str, Any]  # case -> the cell that is pictured
    processor: str
    what: str = "solver"  # or engine
    about: Mapping[str, Mapping[str, str]] = {}  # by solver, what is to be known of it; "law"


class EntryLook(NamedTuple):
    """How a verdict is shown."""

    sign: str
    kind: str  # of the element
    words: str


# Blue-green against vermilion, as Okabe and Ito's for colour-blind readers; signs differ as well.
LOOKS: Final = {
    "passes": EntryLook("\u2713", "passes", "passes"),
    "known failure": EntryLook("~", "known", "known failure: the case declares it; no pass"),
    "fails": EntryLook("\u2717", "fails", "fails"),
    "beyond bounds": EntryLook("\u25a0", "fails", "stopped at the first step beyond a bound"),
    "diverged": EntryLook("\u221e", "fails", "diverged: its numbers ended"),
    "refused": EntryLook("\u2205", "other", "refused: the case cannot be put to it"),
    "not judged": EntryLook("\u25cb", "other", "not judged: the engine does not report enough"),
    "died": EntryLook("\u2020", "fails", "the run broke off: a defect of lavender"),
}
NOT_RUN: Final = EntryLook("\u2013", "other", "not run")
ALWAYS_IN_KEY: Final = ("passes", "known failure", "fails", "beyond bounds")
SMALLER: Final = 0.6  # of a picture's size: rows low enough to see a family at once


def write_matrix(matrix: Matrix, path: Path) -> None:
    """Write the page, whole or not."""
    write_whole(path, page(matrix, path.parent))


def page(matrix: Matrix, folder: Path) -> str:
    """Return the page; links are relative to `folder`."""
    found = {entry.verdict for entry in matrix.entries}
    key = [look for name, look in LOOKS.items() if name in ALWAYS_IN_KEY or name in found]
    if len(matrix.entries) < len(matrix.cases) * len(matrix.solvers):
        key.append(NOT_RUN)
    names: dict[str, list[str]] = {}
    for name, why in matrix.left_out.items():
        names.setdefault(why, []).append(name)
    return render(
        "matrix.html",
        title=f"{count_of(matrix.cases, 'case')} by {count_of(matrix.solvers, matrix.what)}",
        what=matrix.what,
        reduced=any(case.reduced for case in matrix.cases),
        processor=matrix.processor,
        key=key,
        spread=any(entry.least == entry.least for entry in matrix.entries),
        counted=any(entry.contacts == entry.contacts for entry in matrix.entries),
        about=list(matrix.about.items()),
        solvers=[_solver(matrix, solver) for solver in matrix.solvers],
        families=_families(matrix, folder),
        failures=list(filter(None, (_failures(matrix, solver) for solver in matrix.solvers))),
        left_out=list(names.items()),
    )


def _solver(matrix: Matrix, solver: str) -> dict[str, Any]:
    own = [entry.verdict for entry in matrix.entries if entry.solver == solver]
    passed = {"passed": own.count("passes"), "run": len(own)}
    return {"name": solver, "words": solver.split("_"), **passed}


def _families(matrix: Matrix, folder: Path) -> list[dict[str, Any]]:
    """Return the rows of the table, those of one folder of configs together."""
    places = {(entry.case, entry.solver): entry for entry in matrix.entries}
    families: dict[str, list[dict[str, Any]]] = {}
    for case in matrix.cases:
        family, _, short_name = case.name.rpartition("/")
        cell = matrix.shown.get(case.name)
        row = {
            "name": case.name,
            "words": short_name.split("_"),
            "reduced": case.reduced,
            "question": case.question,
            "picture": None if cell is None else picture(cell, SMALLER),
            "entries": [_entry(places.get((case.name, one)), folder) for one in matrix.solvers],
        }
        families.setdefault(family, []).append(row)
    return [{"name": name, "cases": rows} for name, rows in families.items()]


def _entry(entry: Any, folder: Path) -> dict[str, Any]:
    if entry is None:
        return {"look": NOT_RUN, "text": NOT_RUN.words, "was_run": False, "log": "", "counts": []}
    look = LOOKS[entry.verdict]
    text = look.words if entry.verdict == "passes" else f"{entry.verdict}: {entry.why}"
    if not math.isnan(entry.margin):
        text += f"\nleast margin {entry.margin:.3g} of a bound"
    if entry.claim and entry.claim not in text:
        text += f"\n{entry.claim}"
    if entry.least == entry.least:
        text += f"\nover its starts {entry.least:.3g} to {entry.most:.3g}"
    counts = [
        f"{value:.3g} {name}"
        for value, name in ((entry.contacts, "contacts"), (entry.iterations, "iterations"))
        if not math.isnan(value)
    ]
    text += f"\n{', '.join(counts)} a step" if counts else ""
    log = "" if entry.log is None else address(entry.log, folder)
    found = {"look": look, "text": text, "was_run": True, "log": log, "cost": entry.cost}
    found |= {"number": "", "spread": "", "counts": counts}
    if entry.claim and not math.isnan(entry.number):
        found["number"] = f"{entry.number:.3g}"
        if entry.least == entry.least:
            least, most = f"{entry.least:.3g}", f"{entry.most:.3g}"
            found["spread"] = "at every start" if least == most else f"{least} to {most}"
    elif math.isnan(entry.cost):
        found["number"] = entry.verdict  # no run, and nothing to tell in a number
    return found


def _failures(matrix: Matrix, solver: str) -> dict[str, Any] | None:
    """Return what a solver does not pass, by verdict and one by one; None where it passes all."""
    bad = [one for one in matrix.entries if one.solver == solver and one.verdict != "passes"]
    if not bad:
        return None
    by_verdict = [(name, [one.case for one in bad if one.verdict == name]) for name in LOOKS]
    entries = [
        {
            "case": one.case,
            "look": LOOKS[one.verdict],
            "verdict": one.verdict,
            "detail": one.detail or one.why,
        }
        for one in bad
    ]
    listed = [(name, cases) for name, cases in by_verdict if cases]
    return {"name": solver, "by_verdict": listed, "entries": entries}
