"""Files of meshes in a config's tree, as their vertices and triangles:

    {kind: mesh, file: part.stl, scale: 1/1000}
    {kind: mesh, vertices: [...], triangles: [...], scale: 1/1000}

What is run, logged and resumed has no file. A file is one of the project, as those that configs
extend; its path leads from the folder of the config that names it.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

from lavendersim.errors import UsageError
from lavendersim.experiment.inheritance.parents import check_size, project_of
from lavendersim.experiment.mesh_files.obj import read_obj
from lavendersim.experiment.mesh_files.stl import read_stl
from lavendersim.experiment.mesh_files.triangles import FileTriangles, MeshFileError
from lavendersim.experiment.models.meshes import FILE, TRIANGLES
from lavendersim.experiment.models.tree import BODIES
from lavendersim.experiment.text import file as text_file
from lavendersim.experiment.text.node import Mark, Node, graft, key_mark
from lavendersim.experiment.text.node import Path as TreePath
from lavendersim.experiment.text.report import Report
from lavendersim.experiment.text.yaml_text import as_yaml
from lavendersim.quantities.found import found, quoted

LARGEST: Final = 1 << 23  # [byte] as many triangles as a config holds are 4 MB of text
READERS: Final[Mapping[str, Callable[[bytes], FileTriangles]]] = {
    ".obj": read_obj,
    ".stl": read_stl,
}


def with_mesh_files(
    root: Node, files: Mapping[str, Path], report: Report
) -> tuple[Node, str] | None:
    """Return the tree and its text, None where no mesh is of a file; notes what is wrong with one.

    files: the config and those that it extends, each by what messages call it; it comes first.
    """
    named = [(path, shape) for path, shape in _shapes(root) if FILE in shape.entries]
    if not named:
        return None
    tree, read, config = root, dict[str, FileTriangles](), next(iter(files.values()))
    places: dict[str, None] = {}
    for path, shape in named:
        node = shape.get(FILE)
        called, triangles = _read(node, files, read, report)
        if triangles is None:
            continue
        folder = files.get(node.mark.file, config).resolve().parent
        places[os.path.relpath(folder / str(node.text), config.resolve().parent)] = None
        if other := next((key for key in TRIANGLES if key in shape.entries), None):
            sentence = f"{other}: {quoted(node.text)} has them; keep one"
            report.add(key_mark(shape, other), sentence)
            continue
        entries = {key: value for key, value in shape.entries.items() if key != FILE}
        entries |= _nodes(triangles, called, node.mark)
        keys = {key: shape.keys.get(key, node.mark) for key in entries}
        tree = graft(tree, path, Node(entries, shape.mark, keys, shape.incomplete))
    names = " ".join(", ".join(places).split())
    text = f"# {config.name}, with the triangles of {names}.\n{as_yaml(tree.data)}"
    check_size(text, FILE, named[0][1].get(FILE).mark, report)
    return tree, text


def refuse_mesh_files(root: Node, report: Report) -> None:
    """Note each mesh that is of a file, where the config is none and has no folder."""
    for _, shape in _shapes(root):
        node = shape.get(FILE)
        if node.content is not None:
            sentence = "a config given as text has no folder to look in; expected vertices and"
            report.add(node.mark, f"{FILE}: {sentence} triangles, or a config that is a file")


def _shapes(root: Node) -> list[tuple[TreePath, Node]]:
    shapes = root.get("scene", "shapes").entries
    bodies = root.get(*BODIES).entries
    return [
        *((("scene", "shapes", name), shape) for name, shape in shapes.items()),
        *(((*BODIES, name, "shape"), body.get("shape")) for name, body in bodies.items()),
    ]


def _read(
    node: Node, files: Mapping[str, Path], read: dict[str, FileTriangles], report: Report
) -> tuple[str, FileTriangles | None]:
    """Return what messages call the file that is named, and its triangles; None: refused."""

    def refused(sentence: str) -> tuple[str, None]:
        report.add(node.mark, f"{FILE}: {sentence}")
        return "", None

    reader = READERS.get(os.path.splitext(node.text or "")[1].lower())
    if node.text is None or reader is None:
        expected = f"the path of a file *{' or *'.join(READERS)}"
        return refused(f"expected {expected}, found {found(node.data)}")
    if os.path.isabs(node.text):
        return refused(f"expected a path from this file's folder, found {quoted(node.text)}")
    name = node.mark.file if node.mark.file in files else next(iter(files))
    called = os.path.normpath(Path(name).parent / node.text)
    if called in read:
        return called, read[called]
    config = files[name].resolve()
    try:
        path = (config.parent / node.text).resolve()
    except (OSError, RuntimeError, ValueError):  # links in a circle, a null byte
        return refused(f"{quoted(node.text)}: a link that leads nowhere")
    if not path.is_relative_to(project_of(config)):
        return refused(f"{quoted(node.text)} is outside of {project_of(config)}")
    try:
        raw, size = text_file.read_file(path, called, LARGEST)
        if size > LARGEST:
            return refused(f"{called} has {size} bytes; expected at most {LARGEST}")
        read[called] = reader(raw)
        if not read[called].triangles:
            return refused(f"{called} has no triangles")
    except UsageError as error:
        return refused(str(error))
    except MeshFileError as error:
        if error.line == 0:
            return refused(f"{called}: {error}")
        report.add(Mark(error.line, 1, called), str(error))
        return called, None
    return called, read[called]


def _nodes(read: FileTriangles, called: str, named: Mark) -> dict[str, Node]:
    """Return vertices and triangles whose marks are their lines, or, without any, the name's."""

    def rows(values: list, lines: list[int]) -> Node:  # type: ignore[type-arg]
        marks = {line: Mark(line, 1, called) if line else named for line in set(lines)}
        nodes = (
            Node(tuple(Node(value, marks[line]) for value in row), marks[line])
            for row, line in zip(values, lines, strict=True)
        )
        return Node(tuple(nodes), named)

    return {
        "vertices": rows(read.vertices, read.vertex_lines),
        "triangles": rows(read.triangles, read.triangle_lines),
    }
