"""One validation of a tree: pydantic's context, which knows the place of every mapping.

    tree of nodes --plain data--> pydantic --errors--> sentences at their places
                   \\_ where each mapping stands: rules, names, selections _/

Models are entered before their values are checked, so their rules apply to what is there, and a
defect of one value hides none of another.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from functools import cached_property
from typing import Any, Final, TypeVar

from pydantic import BaseModel, ValidationError

from lavendersim.engine.effects import JOINTS
from lavendersim.experiment.checks.messages import report_errors
from lavendersim.experiment.models.experiment import CellSource
from lavendersim.experiment.models.scene import Scene
from lavendersim.experiment.models.shapes import SOLIDS
from lavendersim.experiment.models.tree import ARRANGEMENTS, BODIES, bodies_of, swept_values
from lavendersim.experiment.text.node import ABSENT, Mark, Node, Path
from lavendersim.experiment.text.place import Place
from lavendersim.experiment.text.report import Report
from lavendersim.measures.specs.selection import ANY
from lavendersim.quantities.found import nearest, quoted
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import NamedKind
from lavendersim.quantities.scalars import exact, label

Read = TypeVar("Read", bound=ConfigModel)
KEPT: Final = 64  # sections of cells that are remembered
_known: dict[Node, Any] = {}  # by the node itself: cells of a sweep of other things have one


class Reading:
    """One tree, as it is validated. axes: names of the axes of the sweep."""

    def __init__(self, root: Node, axes: Collection[str], report: Report) -> None:
        self.root = root
        self.models: dict[Path, type[BaseModel]] = {}  # the model that each mapping is read as
        self._report = report
        self._nodes: dict[int, tuple[Node, Path]] = {}  # by the id of the mapping's plain data
        self._noted: list[tuple[Mark, str]] = []
        self.axes = axes
        self._known: dict[NamedKind, Collection[str]] = {}

    def _names(self, kind: NamedKind) -> Collection[str]:
        """Return the names of what is of a kind; each kind is looked for once, when it is asked."""
        known = self._known.get(kind)
        if known is None:
            known = self._known[kind] = _NAMES[kind](self)
        return known

    def connections(self, kinds: Collection[str]) -> list[str]:
        """Return the names of the connections of some kinds."""
        connections = self.root.get("scene", "connections").entries
        return [name for name, one in connections.items() if one.get("kind").text in kinds]

    @cached_property
    def _swept(self) -> dict[str, list[Node]]:
        return swept_values(self.root)

    def read(self, model: type[Read], only: Collection[str] | None = None) -> Read | None:
        """Return the tree as the model; None, with its defects in the report, where it is wrong.

        only: sections to which that is limited; all of them if None.
        """
        data = self._plain(self.root, (), only)
        if only is not None:
            kept = ((key, _known.get(node)) for key, node in self._alone() if key in only)
            data |= {key: section for key, section in kept if section is not None}
        Scene.model_rebuild()  # done once, for files and cells: else each makes it of its own
        try:
            return model.model_validate(data, context=self)
        except ValidationError as error:
            report_errors(error, self.root, self.models, self._report)
            return None
        finally:
            for mark, sentence in self._noted:
                self._report.add(mark, sentence)

    def keep(self, read: CellSource) -> None:
        """Note what was read and found right of sections that stand alone, for other cells."""
        if len(_known) > KEPT:
            _known.clear()
        _known.update({node: getattr(read, key) for key, node in self._alone()})

    def _alone(self) -> Iterator[tuple[str, Node]]:
        entries = self.root.entries
        return ((key, entries[key]) for key in CellSource.ALONE if key in entries)

    def _plain(self, node: Node, path: Path, only: Collection[str] | None = None) -> Any:
        if isinstance(node.content, tuple):
            return tuple(self._plain(item, (*path, k)) for k, item in enumerate(node.content))
        if not isinstance(node.content, dict):
            return node.content
        data = {
            key: self._plain(child, (*path, key))
            for key, child in node.content.items()
            if only is None or key in only
        }
        self._nodes[id(data)] = (node, path)
        return data

    def enter(self, model: type[ConfigModel], data: object) -> None:
        """Apply the rules of a model to the mapping that is about to be read as it."""
        if id(data) in self._nodes:
            node, path = self._nodes[id(data)]
            self.models[path] = model
            self.apply(model, node, path)

    def apply(self, model: type[ConfigModel], node: Node, path: Path) -> None:
        """Apply the rules of a model to a mapping."""
        model.rules(Place(node, path, self.root, self._refuse, self._report.doubt))

    def _refuse(self, mark: Mark, sentence: str) -> None:
        self._noted.append((mark, sentence))

    def refusal_of(self, kind: NamedKind, name: str) -> str | None:
        """Return why nothing, or nothing of this kind, is called so."""
        known = self._names(kind)
        if name not in known:
            if kind == "plane":  # or may have been meant as one
                known = [one for one in known if self._shape_of(one) not in SOLIDS]
            hint = nearest(name, known) or "; this file has none"
            if kind == "surface" and not known:
                hint += f": write surfaces: {{{name}: {{friction: ...}}}} into scene"
            return f"no {kind} is called {quoted(name)}{hint}"
        shape = self._shape_of(name) if kind == "plane" else None
        if shape in SOLIDS:
            return f"{quoted(name)} is a {shape}, expected the name of a plane"
        return None

    def _shape_of(self, body: str) -> str | None:
        return self.root.get(*BODIES, body, "shape", "kind").text

    def check_selection(self, data: object) -> None:
        """Refuse values that their axis does not take."""
        node, _ = self._nodes.get(id(data), (ABSENT, ()))
        for axis, chosen in node.entries.items():
            for value in chosen.items or (chosen,):
                self._check_value(axis, value)

    def _check_value(self, axis: str, value: Node) -> None:
        values = self._swept.get(axis, [])
        if not values or value.text == ANY or isinstance(value.content, tuple | dict):
            return
        if not any(same_value(value, other) for other in values):
            unique = list(dict.fromkeys(label(other.data) for other in values))
            among = ", ".join(unique[:16]) + (", ..." if len(unique) > 16 else "")
            shown = label(value.data)
            self._refuse(value.mark, f"{axis}: {shown} is not among the swept values {among}")


_NAMES: Final[dict[NamedKind, Callable[[Reading], Collection[str]]]] = {
    "body": lambda of: bodies_of(of.root),
    "body or arrangement": lambda of: [
        *bodies_of(of.root),
        *of.root.get(*ARRANGEMENTS).entries,
    ],
    "plane": lambda of: of.root.get(*BODIES).entries,
    "measure": lambda of: of.root.get("measure").entries,
    "rope": lambda of: of.connections(("rope",)),
    "joint": lambda of: of.connections(JOINTS),
    "surface": lambda of: of.root.get("scene", "surfaces").entries,
    "axis": lambda of: of.axes,
}


def same_value(one: Node, other: Node) -> bool:
    """Tell whether two swept values are equal as written: 1/500 equals 0.002, true not 1."""
    if one.number is not None and other.number is not None:
        return exact(one.number) == exact(other.number)
    return type(one.content) is type(other.content) and one.data == other.data
