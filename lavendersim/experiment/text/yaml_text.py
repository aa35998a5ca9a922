"""Plain data as YAML that `text.parse` reads back as the same, to the bit; block by block."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any, Final

LONGEST: Final = 88  # characters of a mapping or a list in one line
# Texts without quotes: no value of another type, and nothing that means something to YAML.
_PLAIN: Final = re.compile(r"(?!(?:null|true|false)\Z)[A-Za-z_][A-Za-z0-9_./-]*\Z", re.IGNORECASE)


def as_yaml(data: Mapping[str, Any]) -> str:
    """Return a mapping of mappings, tuples and scalars as YAML."""
    return "".join(f"{line}\n" for line in _block(data))


def _block(data: Any) -> Iterator[str]:
    if isinstance(data, Mapping):
        items = [(f"{_text(key)}:", value) for key, value in data.items()]
    else:
        items = [("-", value) for value in data]
    for head, value in items:
        inline = _inline(value)
        if len(inline) <= LONGEST or not isinstance(value, Mapping | tuple):
            yield f"{head} {inline}"
        else:
            yield head
            yield from (f"  {line}" for line in _block(value))


def _inline(value: Any) -> str:
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{_text(key)}: {_inline(one)}' for key, one in value.items())}}}"
    if isinstance(value, tuple):
        return f"[{', '.join(map(_inline, value))}]"
    if value is None or isinstance(value, bool):
        return json.dumps(value)
    # Of a ratio both are `1/480`; of a float `repr` has all its digits.
    return _text(value) if isinstance(value, str) else str(value)


def _text(text: str) -> str:
    if _PLAIN.match(text):
        return text
    # Next line is the one character that JSON leaves as it is and YAML breaks lines at.
    return json.dumps(text, ensure_ascii=False).replace("\x85", "\\N")
