"""Bodies over time: what events make of their surfaces, stage by stage.

A stage is what stands between two such events. A plan knows all of them: what only a later surface
requires is part of the engine from the first step on.
"""

from __future__ import annotations

from lavendersim.cell import CellBody, CellConfig, changes_of_bodies


def stages_of(config: CellConfig) -> list[dict[str, CellBody]]:
    """Return the bodies of each stage by name; one alone where no event changes a surface."""
    stages = [config.scene.bodies]
    for event in changes_of_bodies(config.events):
        if event.changes_contacts:
            before = stages[-1]
            stages.append(before | {event.body: event.after(before[event.body])})
    return stages


def later_forms(config: CellConfig) -> dict[str, tuple[CellBody, ...]]:
    """Return what events make of the bodies whose surfaces they change, in the order of time."""
    forms: dict[str, tuple[CellBody, ...]] = {}
    for event in changes_of_bodies(config.events):
        if event.changes_contacts:
            known = forms.get(event.body, ())
            before = known[-1] if known else config.scene.bodies[event.body]
            forms[event.body] = (*known, event.after(before))
    return forms
