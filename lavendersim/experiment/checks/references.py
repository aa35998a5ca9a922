"""Checks that every name and every swept value in a file exists: bodies, measures, axes.

Works on the tree alone, so that a file with other defects has its wrong names told as well.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from lavendersim.experiment.checks.messages import name_of
from lavendersim.experiment.checks.population import body_names
from lavendersim.experiment.checks.walk import Model, Place, places
from lavendersim.experiment.text.node import Mark, Node
from lavendersim.experiment.text.report import Report
from lavendersim.measures.specs.always import CHECKS, COMPLETES, DIVERGES, NONE
from lavendersim.quantities.found import nearest, quoted
from lavendersim.quantities.names import NamedKind
from lavendersim.quantities.scalars import exact, written

ANY_VALUE = "any"
SOLIDS = ("sphere", "box", "capsule", "cylinder", "hull", "compound")


def check_references(root: Node, model: Model, axes: Collection[str], report: Report) -> None:
    """Note every name and swept value below `root` that does not exist."""
    check_names(root, model, axes, report)
    _check_expectation_names(root, report)


def check_names(root: Node, model: Model, axes: Collection[str], report: Report) -> None:
    """Note every name below `root` that does not exist."""
    values = swept_values(root)
    bodies = root.get("scene", "bodies")
    known: dict[NamedKind, Collection[str]] = {
        "body": dict.fromkeys(body_names(root)),
        "plane": bodies.entries if bodies is not None else {},
        "measure": _entries(root, "measure"),
        "surface": _entries(root, "scene", "surfaces"),
        "axis": axes,
    }
    for place in places(model, root):
        if place.refers is not None:
            _check_name(place, place.refers.to, known, bodies, report)
        elif place.axis in values:
            _check_value(place, values[place.axis], report)


def swept_values(root: Node) -> dict[str, list[Node]]:
    """Return the nodes of the values of every axis, over all products of the sweep."""
    values: dict[str, list[Node]] = {}
    for product in products(root):
        for axis, node in product.entries.items():
            listed = node.get("values")
            values.setdefault(axis, []).extend(listed.items if listed is not None else ())
    return values


def products(root: Node) -> tuple[Node, ...]:
    """Return the mappings of axes whose products, one after the other, are the sweep."""
    sweep = root.get("sweep")
    if sweep is None:
        return ()
    return (sweep,) if sweep.entries else sweep.items


def same_value(one: Node, other: Node) -> bool:
    """Tell whether two swept values are equal as written: 1/500 equals 0.002, true not 1."""
    if one.number is not None and other.number is not None:
        return exact(one.number) == exact(other.number)
    return type(one.content) is type(other.content) and one.data == other.data


def _check_name(
    place: Place,
    kind: NamedKind,
    known: Mapping[NamedKind, Collection[str]],
    bodies: Node | None,
    report: Report,
) -> None:
    name, valid = place.node.text or "", known[kind]
    called = name_of(place.path[:-1]) if place.path[-1] == name else name_of(place.path)
    if name not in valid:
        names = _planes(bodies) if kind == "plane" else valid
        hint = nearest(name, names) or "; this file has none"
        report.add(place.mark, f"{called}: no {kind} is called {quoted(name)}{hint}")
    elif kind == "plane" and bodies is not None:
        shape = bodies.get(name, "shape", "kind")
        if shape is not None and shape.text in SOLIDS:
            sentence = f"{called}: {quoted(name)} is a {shape.text}, expected the name of a plane"
            report.add(place.mark, sentence)


def _planes(bodies: Node | None) -> list[str]:
    """Return the bodies that are planes, or may have been meant as one."""
    entries = bodies.entries if bodies is not None else {}
    kinds = {name: body.get("shape", "kind") for name, body in entries.items()}
    return [name for name, kind in kinds.items() if kind is None or kind.text not in SOLIDS]


def _check_value(place: Place, values: Iterable[Node], report: Report) -> None:
    listed = list(values)
    node = place.node
    if not listed or node.text == ANY_VALUE or isinstance(node.content, tuple | dict):
        return
    if not any(same_value(node, value) for value in listed):
        shown = [written(value.data) for value in listed]
        unique = list(dict.fromkeys(shown))
        among = ", ".join(unique[:16]) + (", ..." if len(unique) > 16 else "")
        report.add(
            place.mark,
            f"{place.axis}: {written(node.data)} is not among the swept values {among}",
        )


def _check_expectation_names(root: Node, report: Report) -> None:
    first: dict[str, Mark] = {}
    expect = root.get("expect")
    for item in expect.items if expect is not None else ():
        name = item.get("name")
        if name is None or name.text is None:
            continue
        if name.text in first:
            line = first[name.text].line
            sentence = f"name: {quoted(name.text)} is the name of another expectation, line {line}"
            report.add(name.mark, sentence)
        first.setdefault(name.text, name.mark)
    _check_controls(root, report)


def _check_controls(root: Node, report: Report) -> None:
    """Note what must fail but does not exist, or is the name of two."""
    expect, always = root.get("expect"), root.get("always")
    items = expect.items if expect is not None else ()
    names = [item.get("name") for item in items if item.get("fails") is None]
    claims = [name.text for name in names if name is not None and name.text is not None]
    checks = [COMPLETES, DIVERGES]
    for check in CHECKS if always is not None else ():
        stated = always.get(check) if always is not None else None
        checks += [check] if stated is None or stated.text != NONE else []
    for item in items:
        fails = item.get("fails")
        if fails is None or fails.text is None:
            continue
        if fails.text in claims and fails.text in checks:
            sentence = (
                f"fails: {quoted(fails.text)} is an expectation and a check; rename the first"
            )
            report.add(fails.mark, sentence)
        elif fails.text not in claims and fails.text not in checks:
            hint = nearest(fails.text, [*checks, *claims])
            sentence = f"fails: no expectation or check is called {quoted(fails.text)}{hint}"
            report.add(fails.mark, sentence)


def _entries(root: Node, *path: str) -> Mapping[str, Node]:
    node = root.get(*path)
    return node.entries if node is not None else {}
