"""Kinds of measures of files `measures.py`, in a config's tree as `from_file`.

    hop: {kind: highest, body: ball}
    hop: {kind: from_file, function: highest, sha256: .., meaning: .., parameters: {body: ball}}

A kind is that of the file beside the config that names it, or else of one beside those that it
extends. A file is run where a kind is named that lavender does not have, and not before.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

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

if TYPE_CHECKING:
    from lavendersim.measures.own_file import OwnFile

_COMMON: Final = tuple(Measure.model_fields)  # keys of every measure


def with_own_measures(
    root: Node, files: Mapping[str, Path], report: Report
) -> tuple[Node, str] | None:
    """Return the tree and its text, None where it names no kind of a file; notes wrong values.

    files: the config and those that it extends, each by what messages call it.
    """
    named = {
        name: node
        for name, node in root.get("measure").entries.items()
        if node.get("kind").text not in (*KINDS, None)
    }
    config = next(iter(files.values()))
    folders = _Folders(files)
    found: dict[str, tuple[Node, str, OwnFile]] = {}
    for name, node in named.items():
        kind = node.get("kind")
        known = folders.of(kind.mark.file)
        own = next((one for one in known if kind.text in one.kinds), None)
        if own is not None:
            found[name] = node, str(kind.text), own
            continue
        kinds = [*{one: None for file in known for one in file.kinds}]
        if kind.text is not None and near(kind.text, kinds):
            sentence = f"unknown kind {quoted(kind.text)} in measure.{name}"
            report.add(kind.mark, sentence + nearest(kind.text, kinds))
    if not found:
        return None
    tree = root
    pruned: dict[str, Node] = {}
    fields: dict[str, Any] = {}
    places: dict[str, None] = {}
    for name, (node, kind_name, own) in found.items():
        given = {k: v for k, v in node.entries.items() if k not in (*_COMMON, "kind")}
        pruned[name] = Node(given, node.mark, node.keys, node.incomplete)
        fields[name] = (own.kinds[kind_name].model, ...)
        mark = node.get("kind").mark
        place = os.path.relpath(folders.of_file[own.path].resolve() / FILE, config.parent.resolve())
        places[place] = None
        whole = {
            "kind": Node(FROM_FILE, mark),
            **({} if place == FILE else {"file": Node(place, mark)}),
            "function": Node(kind_name, mark),
            "sha256": Node(own.sha256, mark),
            "meaning": Node(own.kinds[kind_name].meaning, mark),
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
    of = f"{FILE} beside it" if [*places] == [FILE] else " ".join(", ".join(places).split())
    return tree, f"# {config.name}, with kinds of {of}.\n{as_yaml(tree.data)}"


class _Folders:
    """The files of measures beside a config and those that it extends; each is run once."""

    def __init__(self, configs: Mapping[str, Path]) -> None:
        self._configs = configs
        self._read: dict[str, OwnFile] = {}
        self.of_file: dict[str, Path] = {}  # by what messages call a file

    def of(self, config: str) -> Sequence[OwnFile]:
        """Return that beside a config, and then those beside the ones that it extends.

        config: what messages call it, empty for the first.
        """
        names = [*self._configs]
        chain = names[names.index(config) if config in names else 0 :]
        found: dict[str, OwnFile] = {}
        for name in chain:
            folder = self._configs[name].parent
            if not (folder / FILE).is_file():
                continue
            called = str(Path(name).parent / FILE)
            if Path(called).parent.resolve() != folder.resolve():  # its config is a link
                called = str(folder / FILE)
            if called not in self._read:
                from lavendersim.measures.own_file import read_own  # late: it needs numpy

                self._read[called] = read_own(folder / FILE, called)
                self.of_file[called] = folder
            found[called] = self._read[called]
        return [*found.values()]
