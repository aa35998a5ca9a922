"""Bodies over time: what events make of their surfaces, stage by stage.

A stage is what stands between two such events. A plan knows all of them: what only a later surface
requires is part of the engine from the first step on. Where triggers make events happen, nobody
knows their order: every surface that a body may come to have counts, in pairs of any two of them.
"""

from __future__ import annotations

from itertools import combinations, product

from lavendersim.cell import CellBody, CellConfig, CellEvent, changes_of_bodies

Forms = dict[str, tuple[CellBody, ...]]


def stages_of(config: CellConfig) -> list[dict[str, CellBody]]:
    """Return the bodies of each stage by name; one alone where no event changes a surface."""
    stages = [config.scene.bodies]
    if _in_any_order(config):
        return stages + [config.scene.bodies | now for now in _pairs_of(later_forms(config))]
    for event in _changes(config):
        before = stages[-1]
        stages.append(before | {event.body: event.after(before[event.body])})
    return stages


def later_forms(config: CellConfig) -> Forms:
    """Return what events make of the bodies whose surfaces they change, in the order of time."""
    in_any_order, forms = _in_any_order(config), Forms()
    for event in _changes(config):
        known = forms.get(event.body, ())
        first = config.scene.bodies[event.body]
        befores = (first, *known) if in_any_order else (known or (first,))[-1:]
        forms[event.body] = (*known, *map(event.after, befores))
    if in_any_order:  # once more: an earlier one may come after a later one
        for event in _changes(config):
            known = forms[event.body]
            new = [one for one in map(event.after, known) if one not in known]
            forms[event.body] = (*known, *new)
    return forms


def _changes(config: CellConfig) -> list[CellEvent]:
    """Return the events that change a surface, in the order of their time."""
    return [one for one in changes_of_bodies(config.planned_events) if one.changes_contacts]


def _in_any_order(config: CellConfig) -> bool:
    """Whether a trigger makes an event happen that changes a surface."""
    happening = [one.event for one in config.triggered]
    return any(isinstance(one, CellEvent) and one.changes_contacts for one in happening)


def _pairs_of(forms: Forms) -> list[dict[str, CellBody]]:
    """Return forms of one body each, and of two in every combination."""
    alone = [{name: form} for name, later in forms.items() for form in later]
    together = [
        {one: form, other: its}
        for one, other in combinations(forms, 2)
        for form, its in product(forms[one], forms[other])
    ]
    return alone + together
