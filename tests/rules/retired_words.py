"""Words that the project has given up, as data: pattern, what is said now, where, what is left.

`docs/glossary.md` has the words in use. Patterns are searched in lower case, underscores read as
spaces: `make_weigh` is `make weigh`. A word of ordinary English is retired where it was a term.
"""

from __future__ import annotations

from typing import NamedTuple

EVERYWHERE = (
    *("quantities", "cell", "experiment", "geometry", "engine", "scene", "trace", "problems"),
    *("arrow", "comparison", "lint", "laws", "peers", "simulator"),
    *("measures", "figures", "replay", "runner", "cli", "lavendersim", "configs", "docs", "tests"),
)
ENGINE = ("engine", "tests")
CODE = tuple(place for place in EVERYWHERE if place not in ("configs", "docs", "tests"))


class Retired(NamedTuple):
    """A word that is no longer used, and what stands for it."""

    pattern: str
    now: str
    where: tuple[str, ...] = EVERYWHERE


RETIRED = {
    "rub": Retired(r"\brub(s|bed|bing)?\b", "frictional, has friction"),
    "smooth contact": Retired(r"\bsmooth contact|\bby roughness\b", "frictionless contact"),
    "rough": Retired(r"\brough\b", "frictional", ENGINE),
    "call for": Retired(r"\bcall(s|ed|ing)? for\b(?! \w+ in\b)", "requires, required"),
    "wanted": Retired(r"\bwanted\b", "required", ENGINE),
    "told": Retired(r"\btold\b", "reported, described; specified"),
    "untold": Retired(r"\buntold\b|\bdoes not tell it\b", "not reported"),
    "tells (of an engine)": Retired(r"\bengines? (does not |do not )?tells?\b", "reports"),
    "said": Retired(r"\bself\.said\b|\bsaid(: str|: node| =)", "sentence, named, reason", CODE),
    "telling": Retired(r"\b(un)?tell(able|ing)\b", "distinguishing, sampled", CODE),
    "stated": Retired(r"\bstated\b", "specified (in a config), given"),
    "state (to)": Retired(
        r"; states? \w|\b(config|scene|file|must|may) states?\b|\bstates both\b",
        "specify (in a config), declare, give",
    ),
    "mended": Retired(r"\bmend(s|ed|ing)?\b", "fixed"),
    "unsolved": Retired(r"\bunsolved\b", "not converged, did not converge"),
    "price": Retired(r"\bpric(e|es|ed|ing)\b", "overhead"),
    "its way": Retired(
        r"\bway of (a|the|its) (body|centre|step)\b|\bway of\(|\bleast and greatest way\b",
        "displacement",
    ),
    "answer": Retired(r"\banswers?\b", "projected impulse", ("engine",)),
    "seen": Retired(r"\bseen (n|1|2|w)\b", "contact velocity", ENGINE),
    "lack": Retired(r"\black\b", "fixed-point defect", ENGINE),
    "bold": Retired(r"\bbold\b", "sticking guess", ENGINE),
    "weigh": Retired(r"\bweigh\b", "assemble the mass matrix", ENGINE),
    "look along": Retired(r"\blook (along|round)\b", "directional derivative", ENGINE),
    "hastens": Retired(r"\bhastens?\b", "uses_newton"),
    "struck": Retired(r"\bstruck\b", "is_impact, meets", ENGINE),
    "hit, up": Retired(r"\bcontact\.(hit|up)\b", "approach speed, separation speed", ENGINE),
    "doze": Retired(r"\bdoz(e|es|ing)\b", "update sleeping"),
    "pace": Retired(r"\bpaces?\b", "maximum point speed"),
    "lie down": Retired(r"\blies? down\b", "put to sleep"),
    "space": Retired(r"\bspace\.|, space\b|\bspace,", "workspace", ("engine",)),
    "taken": Retired(r"\btaken\[|, taken\b|\btaken,", "colour mask", ("engine",)),
    "whom": Retired(r"\bwhom\b", "which body", ("engine", "scene")),
    "on purpose": Retired(
        r"\bmistakes? (made )?on purpose\b|\bknown mistake\b", "deliberate error"
    ),
    "unparted": Retired(
        r"\bheld\b",
        "compared with, checked against; kept, given for a round; waiting; met",
        tuple(place for place in EVERYWHERE if place not in ("configs", "tests")),
    ),
    "square": Retired(r"\bmatrix square\b|\ba square (for|per)\b", "entry of the matrix"),
}

# Lines with the word that are not renamed yet, or mean something else, by place. Only ever fewer.
# In tests: former spellings that are still read, and names that seed derandomised draws
# (hypothesis hashes a test's source, `test_idle_subsets` a kind's name): others draw other scenes.
LEFT: dict[str, dict[str, int]] = {
    "rub": {"tests": 3},
    "rough": {"tests": 8},
    "call for": {"tests": 1},
    "wanted": {"tests": 2},
    "untold": {"lavendersim": 1, "tests": 1},  # of older logs, as `errors` reads them
    "state (to)": {"engine": 2},
    "unsolved": {"tests": 12},
    "price": {"tests": 8},
    "space": {"engine": 1},  # the title of a paper
}
