"""Former spellings of keys and kinds: read for one version, with a warning that names the new one.

A spelling that this version renames stands here; the next version forgets it.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import Final

from lavendersim.errors import ConfigWarning
from lavendersim.experiment.text.node import Mark, Node, Path, graft, key_mark

KEYS: Final[dict[Path, str]] = {
    ("price",): "overhead",
    ("effects", "smooth_contact"): "frictionless_contact",
    ("cost", "unsolved"): "not_converged",
}
KINDS: Final = {"unsolved_steps": "not_converged_steps"}  # of measures
# A file that is read twice is warned of once.
_SHOWN: dict[str | tuple[str, type[Warning], int], int] = {}


def with_new_spellings(root: Node, name: str) -> Node:
    """Return the tree in this version's spelling; warns of each former one. name: of the file."""
    for path, new in KEYS.items():
        section = root.get(*path[:-1])
        if path[-1] in section.entries and new not in section.entries:
            _warn(name, key_mark(section, str(path[-1])), "key", str(path[-1]), new)
            root = graft(root, path[:-1], _renamed(section, str(path[-1]), new))
    for measure, node in root.get("measure").entries.items():
        kind = node.get("kind")
        if kind.text in KINDS:
            _warn(name, kind.mark, "kind", kind.text, KINDS[kind.text])
            root = graft(root, ("measure", measure, "kind"), Node(KINDS[kind.text], kind.mark))
    return root


def _renamed(section: Node, old: str, new: str) -> Node:
    entries = {new if key == old else key: node for key, node in section.entries.items()}
    keys = {new if key == old else key: mark for key, mark in section.keys.items()}
    return replace(section, content=entries, keys=keys)


def _warn(name: str, mark: Mark, what: str, old: str, new: str) -> None:
    sentence = f'{what} "{old}" is called "{new}" now; the next version refuses the former name'
    message = f"{name}:{mark.line}:{mark.column}: {sentence}"
    warnings.warn_explicit(message, ConfigWarning, name, mark.line, registry=_SHOWN)
