"""Resolving a cell: every default filled in, the bodies in their principal frames."""

from __future__ import annotations

from typing import Any

from lavendersim.cell.config import CellConfig, CellEffects, CellStudy
from lavendersim.cell.events import CellEvent, CellTimestep
from lavendersim.cell.numerics import Numerics
from lavendersim.cell.record import CellRecord, TimeWindow
from lavendersim.experiment.models.events import Event
from lavendersim.experiment.models.experiment import CellSource, NumericsSource
from lavendersim.experiment.models.record import Record, Window
from lavendersim.experiment.resolve.scene import resolve_scene


def resolve_cell(source: CellSource) -> CellConfig:
    """Fill in what the file leaves to defaults; raises SceneError for bodies that cannot be made.

    `source` has passed the checks between its values (`checks`).
    """
    numerics = resolve_numerics(source.numerics)
    return CellConfig.model_construct(
        scene=resolve_scene(source.scene, numerics.timestep, source.duration),
        events=tuple(_event(event) for event in source.events),
        numerics=numerics,
        duration=source.duration,
        record=_record(source.record),
        effects=CellEffects(
            force=source.effects.force, switches=dict(sorted(source.effects.switches.items()))
        ),
        study=CellStudy(mistake=source.study.mistake),
    )


def resolve_numerics(source: str | NumericsSource) -> Numerics:
    """Return every number of the numerics; the preset is merged in already (`with_preset`)."""
    assert isinstance(source, NumericsSource)
    return Numerics.model_construct(
        **{name: getattr(source, name) for name in Numerics.model_fields}
    )


def _event(event: Event) -> CellEvent | CellTimestep:
    if event.body is None:  # `checks.events` let no other event stand without one
        assert event.timestep is not None
        return CellTimestep(at=event.at, timestep=event.timestep)
    kept = event.contact_cache or ("keep" if event.teleport is None else "clear")
    return CellEvent(
        at=event.at,
        body=event.body,
        scale_mass=event.scale_mass,
        teleport=event.teleport,
        velocity=event.velocity,
        angular_velocity=event.angular_velocity,
        contact_cache=kept,
        remove=bool(event.remove),
    )


def _record(record: Record) -> CellRecord:
    return CellRecord(
        residuals=_steps(record.residuals),
        problems=record.problems,
        contacts=_steps(record.contacts),
        poses=_steps(record.poses),
    )


def _steps(recorded: str | Window) -> Any:
    if isinstance(recorded, str):
        return recorded
    return TimeWindow.model_validate({"from": recorded.begin, "to": recorded.end})


__all__ = ["CellConfig", "Numerics", "resolve_cell", "resolve_numerics"]
