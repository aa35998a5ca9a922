"""The tree of a config over that of the file it extends: a merge, key by key.

    both mappings                 key by key, the parent's order first; of another `kind`: replaced
    an item of `expect`           merged into the parent's of the same name, where that stands
    `key: null`                   removes the parent's key; where it has none it stays as written
    a list, a scalar              replaces
    `file` of a mesh              replaces its `vertices` and `triangles`, and these a `file`

Nodes keep their places, so that what is wrong is reported in the file that says it.
"""

from __future__ import annotations

from typing import Final

from lavendersim.experiment.models.meshes import FILE, TRIANGLES
from lavendersim.experiment.resolve.presets import with_named_preset
from lavendersim.experiment.text.node import Node, Path
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.found import nearest, quoted

EXPECT: Final[Path] = ("expect",)  # a list whose items have names
REMOVE: Final = "remove"
# Here null is a value: never stop early.
VALUE_NULL: Final[tuple[Path, ...]] = (("numerics", "tolerance"),)


def merged(parent: Node, child: Node, report: Report) -> Node:
    """Return a config over its parent; notes expectations that are to be removed and are none."""
    if child.get("numerics").entries:
        parent = with_named_preset(parent)  # a preset's name, and the numbers that differ from it
    return _merged(parent, child, (), report)


def _merged(parent: Node, child: Node, path: Path, report: Report) -> Node:
    if path == EXPECT and parent.items and child.items:
        return _expectations(parent, child, report)
    if not isinstance(parent.content, dict) or not isinstance(child.content, dict):
        return child
    kinds = parent.get("kind").text, child.get("kind").text
    if None not in kinds and kinds[0] != kinds[1]:
        return child
    entries, keys = dict(parent.entries), dict(parent.keys)
    for replaced in _other_form(child) if kinds[0] == "mesh" else ():
        entries.pop(replaced, None)
    for key, node in child.entries.items():
        below = (*path, key)
        if node.content is None and key in entries and below not in VALUE_NULL:
            del entries[key]
            keys.pop(key, None)
            continue
        entries[key] = _merged(entries[key], node, below, report) if key in entries else node
        keys[key] = child.keys.get(key, child.mark)
    return Node(entries, child.mark, keys, parent.incomplete or child.incomplete)


def _other_form(mesh: Node) -> tuple[str, ...]:
    """Return the keys that say in another way what a mesh is than those that are written."""
    if mesh.get(FILE).content is not None:
        return TRIANGLES
    return (FILE,) if any(mesh.get(key).content is not None for key in TRIANGLES) else ()


def _expectations(parent: Node, child: Node, report: Report) -> Node:
    """Return the parent's expectations, each with what the child says of it, then the child's."""
    own = {item.get("name").text: item for item in child.items}
    names = [item.get("name").text for item in parent.items]
    items = []
    for name, item in zip(names, parent.items, strict=True):
        other = own.get(name) if name is not None else None
        if other is None:
            items.append(item)
        elif not other.get(REMOVE).is_true:
            items.append(_merged(item, other, (*EXPECT, 0), report))
    for item in child.items:
        name = item.get("name").text
        if name is None or name not in names:
            if name is not None and item.get(REMOVE).is_true:
                hint = nearest(name, [one for one in names if one is not None])
                sentence = f"remove: no expectation of the parent is called {quoted(name)}{hint}"
                report.add(item.get("name").mark, sentence)
            items.append(item)
    return Node(tuple(items), child.mark)
