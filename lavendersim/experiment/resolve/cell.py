"""Resolving a cell: every default filled in, the bodies in their principal frames."""

from __future__ import annotations

from functools import partial

from lavendersim.cell.config import CellConfig, CellEffects, CellStudy
from lavendersim.cell.engine import CellEngine
from lavendersim.cell.numerics import Numerics
from lavendersim.cell.record import CellRecord
from lavendersim.cell.shared_parts import made_once, shared
from lavendersim.experiment.models.experiment import CellSource, NumericsSource
from lavendersim.experiment.models.record import Record
from lavendersim.experiment.models.study import Study
from lavendersim.experiment.resolve.events import resolve_event, resolve_triggered
from lavendersim.experiment.resolve.scene import resolve_scene
from lavendersim.peers.catalogue import LAVENDER, peer_of


def resolve_cell(source: CellSource) -> CellConfig:
    """Fill in what the file leaves to defaults; raises SceneError for bodies that cannot be made.

    `source` has passed the rules of its models.
    """
    assert isinstance(source.numerics, NumericsSource)  # its preset is merged in (`with_preset`)
    numerics = made_once(source.numerics, _numerics)
    engine = engine_of(source)
    scene, frames = resolve_scene(source.scene, numerics.timestep, source.duration)
    resolved = partial(resolve_event, scene=source.scene, frames=frames)
    return CellConfig.of(
        scene=scene,
        events=tuple(resolved(event) for event in source.events if event.when is None),
        numerics=numerics,
        duration=source.duration,
        record=made_once(source.record, _record if engine is None else _record_elsewhere),
        effects=shared(
            CellEffects(
                force=source.effects.force, switches=dict(sorted(source.effects.switches.items()))
            )
        ),
        study=made_once(source.study, _study),
        triggered=tuple(
            resolve_triggered(event, source.scene, frames)
            for event in source.events
            if event.when is not None
        ),
        engine=engine,
    )


def _numerics(source: NumericsSource) -> Numerics:
    return shared(Numerics.model_construct(**dict(source)))


def _record(source: Record) -> CellRecord:
    return CellRecord.model_validate(source.model_dump(by_alias=True))


def _record_elsewhere(source: Record) -> CellRecord:
    """Another engine's log has velocities: whoever judges it has nothing else of its dynamics."""
    return CellRecord.model_validate(source.model_dump(by_alias=True) | {"velocities": True})


def _study(source: Study) -> CellStudy:
    return CellStudy(mistake=source.mistake)


def engine_of(source: CellSource) -> CellEngine | None:
    """Return the engine of a cell with its settings; None: lavender's."""
    if source.engine == LAVENDER:
        return None
    peer = peer_of(source.engine)
    given = getattr(source.engines, peer.name)
    own = {} if given is None else {name: value for name, value in given if value is not None}
    settings = {**peer.variants[source.engine].settings, **own}
    return CellEngine(name=source.engine, settings=dict(sorted(settings.items())))
