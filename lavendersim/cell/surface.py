"""What a body's surface does in a contact: the properties that effects declare."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any

from pydantic import Strict, model_serializer

from lavendersim.engine.effects import SURFACE_KEYS
from lavendersim.quantities.model import ConfigModel, declared

# As in earlier versions: the digest of a cell counts the order of its keys.
_FIRST = ("restitution", "compliance")
_KEYS = sorted(SURFACE_KEYS, key=lambda key: key.name not in _FIRST)
_OF_PAIR = [
    replace(key, type=key.type | None, default=None, doc=f"{key.meaning}; none: as the two mix")
    for key in _KEYS
]


class Properties(ConfigModel):
    """Properties that effects declare, of which some need another one beside them."""

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


class Surface(declared("Surface", Properties, _KEYS), Properties):  # type: ignore[misc]
    """What a body's surface does in a contact; a property that is not specified has its default.

    Each effect declares its properties: default, unit, and how two surfaces mix (`SurfaceKey`). The
    default of a coefficient is 0, without effect. A geometric mean leaves a frictionless surface
    frictionless whatever it touches; compliances add as springs in series do.
    """


class PairProperties(declared("PairProperties", Properties, _OF_PAIR), Properties):  # type: ignore[misc]
    """Properties of contacts of two surfaces; what is None follows from the two surfaces."""


class Partner(PairProperties):
    """A surface by its name, and what is written of contacts with it."""

    surface: str

    @model_serializer
    def written(self) -> dict[str, Any]:
        """Return what is not None."""
        return {name: value for name, value in self if value is not None}


class PairedSurface(Surface):
    """A surface that stands in `surface_pairs`: with its name, and its partners there."""

    name: str
    partners: Annotated[tuple[Partner, ...], Strict(False)]  # a list in a cell's JSON

    def with_partner(self, name: str) -> PairProperties | None:
        """Return what is written of contacts with a surface of this name."""
        return next((one for one in self.partners if one.surface == name), None)
