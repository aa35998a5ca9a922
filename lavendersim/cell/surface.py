"""What a body's surface does in a contact: the properties that effects declare."""

from __future__ import annotations

from typing import Any

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

    @classmethod
    def rules(cls, at: Any) -> None:
        """A property that needs another one stands beside it."""
        for key in SURFACE_KEYS:
            if not key.needs:
                continue
            node, needed = at.get(key.name), at.get(key.needs)
            if node.number is None or node.number <= 0.0:
                continue
            unknown = at.node.incomplete or at.node.entries.keys() - cls.model_fields.keys()
            if not needed and unknown:
                at.doubt()  # a refused key may have been this one
            elif not needed or needed.number == 0.0:
                found = "0" if needed else "none"
                sentence = f"{key.name}: above 0 it needs {key.needs} above 0, found {found}"
                at.refuse(node.mark, sentence)
