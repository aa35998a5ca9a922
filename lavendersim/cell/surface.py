"""What a body's surface does in a contact: the properties that effects declare."""

from __future__ import annotations

from lavendersim.engine.effects import SURFACE_KEYS
from lavendersim.quantities.model import ConfigModel, declared

# As in earlier versions: the digest of a cell counts the order of its keys.
_FIRST = ("restitution", "compliance")
_KEYS = sorted(SURFACE_KEYS, key=lambda key: key.name not in _FIRST)


class Surface(declared("Surface", ConfigModel, _KEYS)):  # type: ignore[misc]
    """What a body's surface does in a contact; a property that is not specified has its default.

    Each effect declares its properties: default, unit, and how two surfaces mix (`SurfaceKey`). The
    default of a coefficient is 0, without effect. A geometric mean leaves a frictionless surface
    frictionless whatever it touches; compliances add as springs in series do.
    """
