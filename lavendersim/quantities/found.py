"""A value of a config in the words of a message; the nearest name to a misspelt one."""

from __future__ import annotations

import difflib
import itertools
from collections.abc import Iterable
from typing import Final

from lavendersim.quantities.scalars import Ratio

# Names of other programs and textbooks, which no spelling leads to.
MEANT: Final = {
    "dt": "timestep",
    "step_size": "timestep",
    "mu": "friction",
    "elasticity": "restitution",
    "bounciness": "restitution",
    "ball": "sphere",
    "cube": "box",
    "cuboid": "box",
    "brick": "box",
    "disc": "cylinder",
    "disk": "cylinder",
    "ground": "plane",
    "mesh": "hull",
    "static": "fixed",
    "bounce": "restitution",
    "diameter": "radius",
    "height": "length",
    "iterations": "sweeps",
    "angle": "degrees",
    "time": "duration",
    "steps": "duration",
    "less_than": "at_most",
    "below": "at_most",
    "max": "at_most",
    "greater_than": "at_least",
    "above": "at_least",
    "min": "at_least",
    "joint": "connection",
    "joints": "connections",
    "ropes": "connections",
    "constraints": "connections",
    "vary": "sweep",
    "parameters": "sweep",
    "checks": "expect",
    "plot": "figure",
    "objects": "bodies",
    "material": "surface",
    "weight": "mass",
    "omega": "angular_velocity",
    "spin": "angular_velocity",
    "from": "between",
    "to": "between",
    "ends": "between",
}
HALVES: Final = {"diameter": "radius"}  # of what the first is, the second is half
LONGEST_QUOTE = 40
MOST_NAMES = 24
MOST_COMPARED = 500  # comparing one misspelt name with more would take noticeable time


def found(value: object) -> str:
    """Return what was found in words a person recognises in the file."""
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return f"the text {quoted(value)}"
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}" if value else "an empty list"
    if isinstance(value, dict):
        return "a mapping"
    if isinstance(value, Ratio):
        return repr(value)
    return f"{value!r}"


def quoted(text: object) -> str:
    """Return the text in double quotes, on one line and cut at a readable length."""
    line = " ".join(str(text).split())
    if len(line) > LONGEST_QUOTE:
        line = line[: LONGEST_QUOTE - 3] + "..."
    return f'"{line}"'


def near(name: object, names: Iterable[str]) -> str | None:
    """Return the valid name that was probably meant, or None when none is near."""
    by_folded: dict[str, str] = {}
    for candidate in itertools.islice(names, MOST_COMPARED):
        by_folded.setdefault(candidate.casefold(), candidate)
    folded = str(name).casefold()[:100]
    if MEANT.get(folded) in by_folded:
        return by_folded[MEANT[folded]]
    for whole, candidate in by_folded.items():
        words = whole.split("_")
        if len(words) > 1 and folded == "".join(word[:1] for word in words):
            return candidate  # "pgs" for "projected_gauss_seidel"
    close = difflib.get_close_matches(folded, by_folded, n=1, cutoff=0.6)
    if not close and len(folded) > 2:
        # people leave words out: "gain" for "stabilisation_gain"
        close = [whole for whole in by_folded if folded in whole]
    if not close:  # "z" for "position_z"
        close = [whole for whole in by_folded if whole.endswith(f"_{folded}")]
    return by_folded[close[0]] if close else None


def nearest(name: object, names: Iterable[str]) -> str:
    """Return `; did you mean "x"?`, or the list of valid names when none is near."""
    valid = list(dict.fromkeys(names))
    if not valid:
        return ""
    if close := near(name, valid):
        return f'; did you mean "{close}"{_share(str(name).casefold(), close)}?'
    more = len(valid) - MOST_NAMES
    listed = ", ".join(valid[:MOST_NAMES]) + (f" and {more} more" if more > 0 else "")
    return f"; valid here: {listed}"


def _share(written: str, meant: str) -> str:
    """Return how much of what was written is what was meant, where it is another quantity."""
    if HALVES.get(written) == meant:
        return ", half as much"
    return ", twice as much" if written.startswith("half") and not meant.startswith("half") else ""
