"""Checks of one scene that no single value shows: what a body needs, and what excludes what.

Works on the tree, and says nothing about values of a wrong type: those are refused elsewhere.
"""

from __future__ import annotations

from lavendersim.experiment.found import near
from lavendersim.experiment.messages import missing_key, place_of
from lavendersim.experiment.node import Mark, Node, Path, key_mark
from lavendersim.experiment.references import SOLIDS
from lavendersim.experiment.report import Report
from lavendersim.experiment.scene_models import Body

_BODIES: Path = ("scene", "bodies")
_OF_MOVABLE = ("mass", "density", "velocity", "angular_velocity")


def check_scene(root: Node, report: Report) -> None:
    """Note what is wrong between the values of `scene`."""
    bodies = root.get(*_BODIES)
    if bodies is None or not isinstance(bodies.content, dict):
        return
    for name, body in bodies.entries.items():
        if body.entries:
            _check_body(body, (*_BODIES, name), report)
    if not bodies.entries:
        report.add(bodies.mark, "bodies: expected at least one movable body, found none")
    elif not any(_may_move(body) for body in bodies.entries.values()):
        scene = root.get("scene") or root
        sentence = "bodies: nothing can move here; expected at least one body that is not fixed"
        report.add(key_mark(scene, "bodies"), sentence)


def kind_of(body: Node) -> str | None:
    """Return the kind of a body's shape, None where it is not stated."""
    kind = body.get("shape", "kind")
    return kind.text if kind is not None else None


def is_static(body: Node) -> bool:
    """Tell whether a body never moves: a plane, or fixed."""
    fixed = body.get("fixed")
    return kind_of(body) == "plane" or (fixed is not None and fixed.content is True)


def _may_move(body: Node) -> bool:
    return not is_static(body)


def _stated(body: Node, key: str) -> Mark | None:
    """Return where a key stands; null states nothing."""
    child = body.get(key)
    return None if child is None or child.content is None else key_mark(body, key)


def _check_body(body: Node, path: Path, report: Report) -> None:
    kind = kind_of(body)
    if kind == "plane":
        _check_plane(body, path, report)
    elif kind in SOLIDS:
        _check_solid(body, path, report)


def _check_solid(body: Node, path: Path, report: Report) -> None:
    _exactly_one_start(body, path, report)
    if is_static(body):
        for key in _OF_MOVABLE:
            if mark := _stated(body, key):
                sentence = f"{key}: {place_of(path)} is fixed; a fixed body has no {_words(key)}"
                report.add(mark, sentence)
        if mark := _stated(body, "release"):
            sentence = f"release: {place_of(path)} is fixed and stays; state its position"
            report.add(mark, sentence)
        return
    mass, density = _stated(body, "mass"), _stated(body, "density")
    if mass and density:
        report.add(max(mass, density), f"{place_of(path)} states both mass and density; keep one")
    elif not mass and not density:
        meaning = "[kg], or a density [kg/m^3], or fixed: true"
        _missing(body, ("mass", "density"), path, meaning, report)


def _check_plane(body: Node, path: Path, report: Report) -> None:
    fixed = body.get("fixed")
    if fixed is not None and fixed.content is False:
        report.add(fixed.mark, f"fixed: {place_of(path)} is a plane; planes are always fixed")
    for key in (*_OF_MOVABLE, "position", "release", "orientation"):
        if mark := _stated(body, key):
            instead = (
                "; its normal and offset say where it is"
                if key in ("position", "release", "orientation")
                else ""
            )
            sentence = f"{key}: {place_of(path)} is a plane; a plane has no {_words(key)}{instead}"
            report.add(mark, sentence)


def _exactly_one_start(body: Node, path: Path, report: Report) -> None:
    position, release = _stated(body, "position"), _stated(body, "release")
    if position and release:
        later = max(position, release)
        report.add(later, f"{place_of(path)} states both position and release; keep one")
    elif not position and not release:
        meaning = "[m], or a release above a plane"
        _missing(body, ("position", "release"), path, meaning, report)


def _missing(body: Node, keys: tuple[str, ...], path: Path, meaning: str, report: Report) -> None:
    """Note that a body has none of the keys, unless a refused key may have been one of them."""
    unknown = [key for key in body.entries if key not in Body.model_fields]
    if body.torn or any(near(key, Body.model_fields) in keys for key in unknown):
        report.doubt()
    else:
        report.add(body.mark, missing_key(keys[0], path, meaning))


def _words(key: str) -> str:
    return key.replace("_", " ")
