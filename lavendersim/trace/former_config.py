"""The resolved config of logs before it was JSON: YAML of any depth and size, read within limits.

PyYAML's composer in C ends the process where brackets are nested 100,000 times, and a text of nine
aliases can stand for a billion values.
"""

from __future__ import annotations

from typing import Any, Final

import yaml

MOST_LEVELS: Final = 64  # a config has about ten
MOST_VALUES: Final = 1_000_000  # when aliases are written out
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def former_config(text: bytes) -> dict[str, Any]:
    """Return the config as plain data. ValueError for a text that is none."""
    try:
        level = 0
        for event in yaml.parse(text, _LOADER):
            level += isinstance(event, yaml.CollectionStartEvent)
            level -= isinstance(event, yaml.CollectionEndEvent)
            if level > MOST_LEVELS:
                raise ValueError(f"nested deeper than {MOST_LEVELS} levels")
        loaded = yaml.load(text, _LOADER)
    except yaml.YAMLError as error:
        raise ValueError(f"no YAML of plain values: {type(error).__name__}") from None
    if not isinstance(loaded, dict) or _values(loaded, {}) > MOST_VALUES:
        raise ValueError(f"no mapping of at most {MOST_VALUES} values")
    return loaded


def _values(value: Any, known: dict[int, int]) -> int:
    """Return how many values there are below one; known: by id, as aliases are of one object."""
    if not isinstance(value, dict | list):
        return 1
    if id(value) not in known:
        known[id(value)] = MOST_VALUES + 1  # of what contains itself
        below = value.values() if isinstance(value, dict) else value
        known[id(value)] = 1 + sum(_values(one, known) for one in below)
    return known[id(value)]
