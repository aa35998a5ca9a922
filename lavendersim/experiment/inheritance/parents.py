"""The files that a config extends, read and merged: config -> parent -> parent's parent -> ...

A parent is a file of the project, so that no config, whoever wrote it, has lavender read another
one: links followed, it stands below the nearest folder above the config that has `.git` or
`pyproject.toml`, or, where there is none, below the folder above the config's own.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Final, NamedTuple

from lavendersim.errors import UsageError
from lavendersim.experiment.inheritance.merge import merged
from lavendersim.experiment.text.file import read_file
from lavendersim.experiment.text.former import with_new_spellings
from lavendersim.experiment.text.node import Mark, Node
from lavendersim.experiment.text.parse import parse
from lavendersim.experiment.text.report import Report
from lavendersim.experiment.text.yaml_text import as_yaml
from lavendersim.quantities.found import found, quoted

EXTENDS: Final = "extends"
MOST_PARENTS: Final = 8  # one above the other
PROJECT: Final = (".git", "pyproject.toml")  # what the uppermost folder of a project has
SUFFIXES: Final = (".yaml", ".yml")


class Whole(NamedTuple):
    """A config over those that it extends."""

    tree: Node
    text: str
    files: Mapping[str, Path]  # it and its parents, by what messages call them; it comes first


def with_parents(root: Node, path: Path, name: str, report: Report) -> Whole | None:
    """Return the tree over those of all files that it extends; None without one.

    name: of the file in messages, by which those of its parents are found and called, too. What is
    wrong with a parent is noted at its place in that file, and what is wrong with naming it at
    `extends`.
    """
    if EXTENDS not in root.entries:
        return None
    named = root.get(EXTENDS)
    chain, names, trees = [path.resolve()], [name], [root]
    project = project_of(chain[0])
    while (here := trees[-1].get(EXTENDS)) and here.content is not None:
        parent = _parent(here, (chain, names, project), report)
        if parent is None:
            return Whole(root, "", {})
        trees.append(parent)
    tree = _without(trees[-1])
    for child in reversed(trees[:-1]):
        tree = merged(tree, _without(child), report)
    files = ", ".join(os.path.relpath(file, chain[0].parent) for file in chain)
    text = f"# {' '.join(files.split())}: merged, the first over those that it extends.\n"
    text += as_yaml(tree.data)
    check_size(text, EXTENDS, named.mark, report)
    return Whole(tree, text, dict(zip(names, chain, strict=True)))


def project_of(path: Path) -> Path:
    """Return the folder below which a config's parents stand; path: with links followed."""
    for folder in path.parents:
        if any((folder / mark).exists() for mark in PROJECT):
            return folder
    return path.parent.parent


def _parent(named: Node, known: tuple[list[Path], list[str], Path], report: Report) -> Node | None:
    """Return the tree of the file that is named; notes why it is none. known: grows by it."""
    chain, names, project = known

    def refuse(sentence: str) -> None:
        report.add(named.mark, f"{EXTENDS}: {sentence}")

    if named.text is None or not named.text.endswith(SUFFIXES):
        refuse(
            f"expected the path of a file *.yaml, such as ../base.yaml, found {found(named.data)}"
        )
        return None
    called = quoted(named.text)
    if os.path.isabs(named.text):
        refuse(f"expected a path from this file's folder, found {called}")
        return None
    try:
        file = (chain[-1].parent / named.text).resolve()
    except (OSError, RuntimeError):  # links in a circle
        refuse(f"{called}: a link that leads nowhere")
        return None
    if not file.is_relative_to(project):
        refuse(f"{called} is outside of {project}, expected a file of the project")
        return None
    if file in chain:
        refuse(f"{called} extends this file in turn; expected no circle")
        return None
    if len(chain) > MOST_PARENTS:
        refuse(f"expected at most {MOST_PARENTS} files one above the other")
        return None
    name = os.path.normpath(Path(names[-1]).parent / named.text)
    try:
        raw, size = read_file(file, name)
    except UsageError as error:
        refuse(str(error))
        return None
    tree = parse(raw, report, size, name)
    if tree is None:
        return None
    if not isinstance(tree.content, dict):
        report.add(tree.mark, f"expected a mapping, found {found(tree.data)}")
        return None
    chain.append(file)
    names.append(name)
    return with_new_spellings(tree, name)


def _without(tree: Node) -> Node:
    entries = {key: node for key, node in tree.entries.items() if key != EXTENDS}
    return Node(entries, tree.mark, tree.keys, tree.incomplete)


def check_size(text: str, key: str, mark: Mark, report: Report) -> None:
    """Note at a key why the text of several files is longer than one may be."""
    own = Report("")
    parse(text.encode("utf-8", "surrogatepass"), own)
    for defect in own.defects[:1]:
        report.add(mark, f"{key}: of all files together: {defect.message}")
