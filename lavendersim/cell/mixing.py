"""What holds in a contact between two surfaces: each property mixed by the rule of its effect.

The rules stand with the keys that effects declare (`SurfaceKey.mix`): the larger restitution, the
geometric mean of friction, the sum of compliances. Scene, plan and measures mix here and nowhere
else.
"""

from __future__ import annotations

from lavendersim.cell.surface import Surface
from lavendersim.engine.effects import SURFACE_KEYS


def mixed(one: Surface, other: Surface) -> Surface:
    """Return the surface of a contact between two surfaces; the order of the two says nothing."""
    values = {
        key.name: key.mix(getattr(one, key.name), getattr(other, key.name)) for key in SURFACE_KEYS
    }
    surface: Surface = Surface.model_construct(**values)
    return surface
