"""What a body's surface does in a contact: the properties that effects declare."""

from __future__ import annotations

from lavendersim.engine.effects import SURFACE_KEYS
from lavendersim.quantities.model import ConfigModel, declared

# As in earlier versions: the digest of a cell counts the order of its keys.
_FIRST = ("restitution", "compliance")
_KEYS = sorted(SURFACE_KEYS, key=lambda key: key.name not in _FIRST)


class Surface(declared("Surface", ConfigModel, _KEYS)):  # type: ignore[misc]
    """What a body's surface does in a contact; a property that is not specified is 0.

    In a contact of two surfaces friction is the geometric mean sqrt(mu_a mu_b), so that a
    frictionless surface stays frictionless; compliances add (two springs in series); restitution,
    torsional and rolling friction are the larger of the two.
    """
