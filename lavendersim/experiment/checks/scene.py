"""Checks of one scene that no single value shows: what a body needs, and what excludes what.

Works on the tree, and says nothing about values of a wrong type: those are refused elsewhere.
"""

from __future__ import annotations

from lavendersim.experiment.checks.messages import missing_key, place_of
from lavendersim.experiment.checks.population import (
    ARRANGEMENTS,
    BODIES,
    described,
    entries,
    member_name,
    members,
)
from lavendersim.experiment.checks.references import SOLIDS
from lavendersim.experiment.models.arrangements import MOST_BODIES
from lavendersim.experiment.models.bodies import Body
from lavendersim.experiment.text.node import Mark, Node, Path, key_mark
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.found import near, quoted

_OF_MOVING = ("velocity", "angular_velocity")
_OF_MOVABLE = ("mass", "density", "inertia", "drag")


def check_scene(root: Node, report: Report) -> None:
    """Note what is wrong between the values of `scene`."""
    bodies = root.get(*BODIES)
    if bodies is None or not isinstance(bodies.content, dict):
        return
    for path, body in described(root):
        if body.entries:
            _check_body(body, path, report)
    _check_names_of_members(root, report)
    gravity = root.get("scene", "gravity")
    if gravity is not None:
        _check_gravity(gravity, report)
    if not any(True for _ in described(root)):
        report.add(bodies.mark, "bodies: expected at least one movable body, found none")
    elif not any(_may_move(body) for _, body in described(root)):
        scene = root.get("scene") or root
        sentence = "bodies: nothing can move here; expected at least one body that is not fixed"
        report.add(key_mark(scene, "bodies"), sentence)


def _check_gravity(gravity: Node, report: Report) -> None:
    tilt, slope = _stated(gravity, "tilt_degrees"), _stated(gravity, "slope")
    if tilt and slope:
        sentence = "gravity states both tilt_degrees and slope; keep one"
        report.add(max(tilt, slope), sentence)


def _check_names_of_members(root: Node, report: Report) -> None:
    """Note arrangements that are too large, and those with a body named like one in `bodies`."""
    single, total = entries(root, *BODIES), 0
    arrangements = root.get(*ARRANGEMENTS)
    for name, arrangement in entries(root, *ARRANGEMENTS).items():
        assert arrangements is not None
        count = members(arrangement)
        total += count
        if total > MOST_BODIES:
            sentence = f"{name}: {total} bodies in arrangements, expected at most {MOST_BODIES}"
            report.add(key_mark(arrangements, name), sentence)
            return
        numbers = range(1, count + 1)
        clash = next((n for n in numbers if member_name(name, n) in single), None)
        if clash is not None:
            sentence = (
                f"{name}: its body {quoted(member_name(name, clash))} has a namesake in bodies"
            )
            report.add(key_mark(arrangements, name), sentence)


def kind_of(body: Node) -> str | None:
    """Return the kind of a body's shape, None where it is not stated."""
    kind = body.get("shape", "kind")
    return kind.text if kind is not None else None


def is_static(body: Node) -> bool:
    """Tell whether a body never moves: a plane, or fixed."""
    return kind_of(body) == "plane" or _is_true(body, "fixed")


def is_kinematic(body: Node) -> bool:
    """Tell whether a body moves as its velocity says, whatever touches it."""
    return _is_true(body, "kinematic")


def _is_true(body: Node, key: str) -> bool:
    value = body.get(key)
    return value is not None and value.content is True


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
    if path[:2] == BODIES:
        _exactly_one_start(body, path, report)
    fixed, kinematic = is_static(body), is_kinematic(body)
    if fixed and kinematic:
        report.add(
            max(key_mark(body, "fixed"), key_mark(body, "kinematic")),
            f"{place_of(path)} states both fixed and kinematic; keep one",
        )
        return
    if fixed or kinematic:
        word = "fixed" if fixed else "kinematic"
        for key in (*_OF_MOVABLE, *(_OF_MOVING if fixed else ())):
            if mark := _stated(body, key):
                sentence = f"{key}: {place_of(path)} is {word}; a {word} body has no {_words(key)}"
                report.add(mark, sentence)
        if mark := _stated(body, "release"):
            goes = "stays" if fixed else "goes its own way"
            sentence = f"release: {place_of(path)} is {word} and {goes}; state its position"
            report.add(mark, sentence)
        return
    mass, density = _stated(body, "mass"), _stated(body, "density")
    if mass and density:
        report.add(max(mass, density), f"{place_of(path)} states both mass and density; keep one")
    elif not mass and not density:
        meaning = "[kg], or a density [kg/m^3], or fixed: true"
        _missing(body, ("mass", "density"), path, meaning, report)
    _check_inertia(body, path, report)


def _check_inertia(body: Node, path: Path, report: Report) -> None:
    inertia, kind = body.get("inertia"), kind_of(body)
    if inertia is None or inertia.content is None:
        return
    if kind in ("hull", "compound"):
        sentence = f"inertia: {place_of(path)} is a {kind}; its shape says it, leave it out"
        report.add(key_mark(body, "inertia"), sentence)
        return
    moments = [item.number for item in inertia.items]
    numbers = sorted(moment for moment in moments if moment is not None)
    # 1, 2, 3 is a flat body, the limit; written numbers may miss it by their round-off.
    if len(numbers) == 3 and numbers[2] > (numbers[0] + numbers[1]) * (1.0 + 1e-12):
        sentence = "inertia: no body has a moment above the sum of the other two"
        largest = moments.index(numbers[2])
        report.add(inertia.items[largest].mark, f"{sentence}, found {numbers[2]:g}")


def _check_plane(body: Node, path: Path, report: Report) -> None:
    fixed = body.get("fixed")
    if fixed is not None and fixed.content is False:
        report.add(fixed.mark, f"fixed: {place_of(path)} is a plane; planes are always fixed")
    for key in (*_OF_MOVABLE, *_OF_MOVING, "kinematic", "position", "release", "orientation"):
        if mark := _stated(body, key):
            instead = (
                "; its normal and offset say where it is"
                if key in ("position", "release", "orientation")
                else ""
            )
            sentence = f"{key}: {place_of(path)} is a plane; a plane has no {_words(key)}{instead}"
            if key == "kinematic":
                sentence = f"kinematic: {place_of(path)} is a plane; planes are always fixed"
                if not _is_true(body, key):
                    continue
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
