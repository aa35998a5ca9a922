"""Resolving pairs of surfaces: a surface that stands in some takes its partners along."""

from __future__ import annotations

from collections.abc import Mapping

from lavendersim.cell.surface import PairedSurface, PairProperties, Partner, Surface
from lavendersim.experiment.models.scene import Scene
from lavendersim.experiment.models.surface_pairs import SurfacePair


def with_partners(name: str, surface: Surface, pairs: Mapping[str, SurfacePair]) -> Surface:
    """Return a named surface with what is written of its contacts; itself where nothing is."""
    partners = []
    for pair in pairs.values():
        if name in pair.between:
            one, two = pair.between
            written = {key: getattr(pair, key) for key in PairProperties.model_fields}
            partners.append(Partner(surface=two if name == one else one, **written))
    if not partners:
        return surface
    own = {key: getattr(surface, key) for key in Surface.model_fields}
    resolved: PairedSurface = PairedSurface(name=name, partners=tuple(partners), **own)
    return resolved


def surface_of(written: str | Surface, scene: Scene) -> Surface:
    """Return a surface by its name or as it stands."""
    if isinstance(written, str):
        return with_partners(written, scene.surfaces[written], scene.surface_pairs)
    return written
