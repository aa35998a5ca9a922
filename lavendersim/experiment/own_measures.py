"""Kinds of measures of the file `measures.py` beside a config, in its tree as `from_file`.

    hop: {kind: highest, body: ball}
    hop: {kind: from_file, function: highest, sha256: .., meaning: .., parameters: {body: ball}}

The file is run where the config names a kind that lavender does not have, and not before.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from pydantic import create_model

from lavendersim.experiment.checks.reading import Reading
from lavendersim.experiment.resolve.formulas import with_numbers
from lavendersim.experiment.text.node import Node, graft
from lavendersim.experiment.text.report import Report
from lavendersim.experiment.text.yaml_text import as_yaml
from lavendersim.measures.specs.base import Measure
from lavendersim.measures.specs.catalogue import KINDS
from lavendersim.measures.specs.own import FILE, FROM_FILE
from lavendersim.quantities.found import near, nearest, quoted
from lavendersim.quantities.model import ConfigModel

_COMMON: Final = tuple(Measure.model_fields)  # keys of every measure


def with_own_measures(root: Node, path: Path, report: Report) -> tuple[Node, str] | None:
    """Return the tree and its text, None where it names no kind of the file; notes wrong values."""
    named = {
        name: node
        for name, node in root.get("measure").entries.items()
        if node.get("kind").text not in (*KINDS, None)
    }
    if not named or not (path.parent / FILE).is_file():
        return None
    from lavendersim.measures.own_file import read_own  # late: it needs numpy

    own = read_own(path.parent / FILE)
    found = {name: node for name, node in named.items() if node.get("kind").text in own.kinds}
    for name in named.keys() - found.keys():
        unknown, kinds = named[name].get("kind"), list(own.kinds)
        if unknown.text is not None and near(unknown.text, kinds):
            sentence = f"unknown kind {quoted(unknown.text)} in measure.{name}"
            report.add(unknown.mark, sentence + nearest(unknown.text, kinds))
    if not found:
        return None
    tree = root
    pruned: dict[str, Node] = {}
    fields: dict[str, Any] = {}
    for name, node in found.items():
        kind = str(node.get("kind").text)
        given = {k: v for k, v in node.entries.items() if k not in (*_COMMON, "kind")}
        pruned[name] = Node(given, node.mark, node.keys, node.incomplete)
        fields[name] = (own.kinds[kind].model, ...)
        mark = node.get("kind").mark
        whole = {
            "kind": Node(FROM_FILE, mark),
            "function": Node(kind, mark),
            "sha256": Node(own.sha256, mark),
            "meaning": Node(own.kinds[kind].meaning, mark),
            "parameters": pruned[name],
            **{k: v for k, v in node.entries.items() if k in _COMMON},
        }
        keys = {key: node.keys.get(key, mark) for key in whole}
        tree = graft(tree, ("measure", name), Node(whole, node.mark, keys))
    alone = Node(pruned, root.get("measure").mark, root.get("measure").keys)
    checked = graft(root, ("measure",), alone)
    section = create_model("OwnMeasures", __base__=ConfigModel, **fields)
    model = create_model("OwnSection", __base__=ConfigModel, measure=(section, ...))
    checked, _ = with_numbers(checked, Report(""))  # what is wrong with formulas is said later
    Reading(checked, (), report).read(model, only=("measure",))
    return tree, f"# {path.name}, with kinds of {FILE} beside it.\n{as_yaml(tree.data)}"
