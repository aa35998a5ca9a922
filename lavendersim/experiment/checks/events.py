"""Checks of events against the scene, the run's length and each other. Works on the tree.

Says nothing about values of a wrong type: those are refused elsewhere.
"""

from __future__ import annotations

from typing import NamedTuple

from lavendersim.experiment.checks.messages import missing_key, place_of
from lavendersim.experiment.checks.population import body_node
from lavendersim.experiment.checks.scene import is_kinematic, is_static, kind_of
from lavendersim.experiment.text.node import Node, key_mark
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.found import near

REMOVE = "remove"
CHANGES = ("scale_mass", "teleport", "velocity", "angular_velocity", "contact_cache", REMOVE)


class Removal(NamedTuple):
    """When a body is removed."""

    at: float  # [s]
    event: int  # its index


def check_events(root: Node, length: float | None, report: Report) -> None:
    """Note what is wrong with events, and with forces on bodies that are gone; length: [s]."""
    events = root.get("events")
    items = events.items if events is not None else ()
    gone = _removals(items)
    for index, event in enumerate(items):
        if event.entries:
            _check_event(event, index, root, length, report)
            _check_is_there(event, index, gone, report)
    forces = root.get("scene", "forces")
    for force in forces.items if forces is not None else ():
        _check_force_ends(force, gone, report)


def _removals(items: tuple[Node, ...]) -> dict[str, Removal]:
    """Return the first removal of each body that is removed, by its name."""
    gone: dict[str, Removal] = {}
    for index, event in enumerate(items):
        at, body = event.get("at"), event.get("body")
        if not _removes(event) or at is None or body is None:
            continue
        if at.number is not None and body.text is not None:
            one = Removal(at.number, index)
            gone[body.text] = min(gone.get(body.text, one), one)
    return gone


def _removes(event: Node) -> bool:
    stated = event.get(REMOVE)
    return stated is not None and stated.content is True


def _check_event(event: Node, index: int, root: Node, length: float | None, report: Report) -> None:
    at, body = event.get("at"), event.get("body")
    if at is not None and at.number is not None and length is not None and at.number > length > 0:
        sentence = f"at: {at.number:g} s is after the end of the run, duration {length:g} s"
        report.add(at.mark, sentence)
    timestep = event.get("timestep")
    if timestep is not None and timestep.content is not None:
        _check_timestep(event, index, report)
        return
    if body is None or body.content is None:
        _check_lacks_body(event, index, report)
        return
    if _removes(event):
        _check_removal(event, index, report)
        return
    if body.text is not None:
        target = body_node(root, body.text)
        if target is not None and is_static(target):
            what = "a plane" if kind_of(target) == "plane" else "fixed"
            report.add(body.mark, f'body: "{body.text}" is {what}; expected a movable body')
        elif target is not None and is_kinematic(target) and event.get("scale_mass"):
            sentence = f'scale_mass: "{body.text}" is kinematic; a kinematic body has no mass'
            report.add(key_mark(event, "scale_mass"), sentence)
    stated = [key for key in CHANGES if event.get(key) and key != REMOVE]
    if not stated:
        changes = f"{', '.join(CHANGES[:-1])} or {CHANGES[-1]}"
        sentence = f"{place_of(('events', index))} changes nothing; expected {changes}"
        report.add(event.mark, sentence)
    cache = event.get("contact_cache")
    if cache is not None and cache.text == "keep" and "teleport" in stated:
        sentence = "contact_cache: a teleport always clears the body's cached contacts"
        report.add(cache.mark, sentence)


def _check_lacks_body(event: Node, index: int, report: Report) -> None:
    """Without a body there is only a timestep to change; a misspelt key is told elsewhere."""
    unknown = event.entries.keys() - {"at", "body", "timestep", *CHANGES}
    if event.torn or any(near(key, ("body", "timestep")) for key in unknown):
        return
    meaning = "name of a body, or else a timestep"
    report.add(event.mark, missing_key("body", ("events", index), meaning))


def _check_timestep(event: Node, index: int, report: Report) -> None:
    """An event of the timestep is of nothing else."""
    for key in ("body", *CHANGES):
        if event.get(key):
            sentence = (
                f"{key}: {place_of(('events', index))} changes the timestep; what happens to a body"
                " is an event of its own"
            )
            report.add(key_mark(event, key), sentence)
            return


def _check_removal(event: Node, index: int, report: Report) -> None:
    """An event that removes a body does nothing else to it."""
    for key in CHANGES[:-1]:
        if event.get(key):
            sentence = f"{key}: {place_of(('events', index))} removes the body; expected no change"
            report.add(key_mark(event, key), sentence)
            return


def _check_is_there(event: Node, index: int, gone: dict[str, Removal], report: Report) -> None:
    at, body = event.get("at"), event.get("body")
    removal = gone.get(body.text or "") if body is not None else None
    if body is None or at is None or at.number is None or removal is None:
        return
    if Removal(at.number, index) > removal:
        report.add(body.mark, _gone("body", body.text, removal))


def _check_force_ends(force: Node, gone: dict[str, Removal], report: Report) -> None:
    body, end = force.get("body"), force.get("to")
    removal = gone.get(body.text or "") if body is not None else None
    if body is None or removal is None:
        return
    if end is None:
        hint = f"; expected to: {removal.at:g}"
        report.add(body.mark, _gone("body", body.text, removal) + hint)
    elif end.number is not None and end.number > removal.at:
        report.add(end.mark, _gone("to", body.text, removal))


def _gone(key: str, name: str | None, removal: Removal) -> str:
    event = place_of(("events", removal.event))
    return f'{key}: "{name}" is removed at {removal.at:g} s by {event}'
