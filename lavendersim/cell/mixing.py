"""What holds in a contact between two surfaces: what is written of the pair, the rest mixed.

The rules stand with the keys that effects declare (`SurfaceKey.mix`): the larger restitution, the
geometric mean of friction, the sum of compliances. What `scene.surface_pairs` says of two surfaces
takes the place of what follows from them. Scene, plan and measures mix here and nowhere else.
"""

from __future__ import annotations

from typing import Any, Final

from lavendersim.cell.surface import PairedSurface, PairProperties, Surface
from lavendersim.engine.effects import SURFACE_KEYS

# Pairs that were mixed, by the identities of their surfaces, which are kept with them: no other
# surface gets theirs. Cells of a sweep share surfaces, and each pair is asked for several times.
MOST_KNOWN: Final = 1024
_known: dict[tuple[int, int], tuple[Surface, Surface, Surface]] = {}


def mixed(one: Surface, other: Surface) -> Surface:
    """Return the surface of a contact between two surfaces; the order of the two says nothing."""
    key = id(one), id(other)
    known = _known.get(key)
    if known is None:
        if len(_known) >= MOST_KNOWN:
            _known.clear()
        known = _known[key] = one, other, _mixed(one, other)
    return known[2]


def _mixed(one: Surface, other: Surface) -> Surface:
    values: dict[str, Any] = {
        key.name: key.mix(getattr(one, key.name), getattr(other, key.name)) for key in SURFACE_KEYS
    }
    if (written := _written(one, other)) is not None:
        own = {name: getattr(written, name) for name in values}
        values |= {name: value for name, value in own.items() if value is not None}
    surface: Surface = Surface.model_construct(**values)
    return surface


def _written(one: Surface, other: Surface) -> PairProperties | None:
    """Return what is written of contacts of the two; both have it."""
    if isinstance(one, PairedSurface) and isinstance(other, PairedSurface):
        return one.with_partner(other.name)
    return None
