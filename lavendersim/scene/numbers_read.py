"""Whether a plan depends on numbers of bodies: the facts of a scene, noting what is read of them.

A decision is a function of what it reads. Where none of them read where a body starts or how fast,
or none how heavy it is, each comes out the same for every scene that differs in that alone, and
need not be made again.
"""

from __future__ import annotations

from typing import Any, Final

from lavendersim.cell.shapes.shape import Primitive
from lavendersim.engine.effects import Facts

# Of a body as predicates see it and of its config; of a scene, what leads to its bodies.
STARTS: Final = frozenset({"position", "release", "velocity", "speed", "bodies"})
MASSES: Final = frozenset({"mass", "density", "inertia", "bodies"})
_CONFIGS: Final = frozenset({"later", "forms"})  # of a body: as events make it
# Moments whose ratio is nearer to 1 may be equal with one mass and not with another.
_APART: Final = 1e-9


class NumbersRead:
    """Notes which numbers of bodies were read of the facts that it watches."""

    def __init__(self) -> None:
        self.watches = False
        self.starts = False  # where a body starts or how fast was read
        self.masses = False  # how heavy one is

    @property
    def none(self) -> bool:
        """Whether facts were watched, and none of these numbers was read."""
        return self.watches and not self.starts and not self.masses

    def watched(self, facts: Facts) -> Facts:
        """Return the facts with bodies and scene that note what is read of them."""
        self.watches = True
        bodies: Any = tuple(_Watched(body, self) for body in facts.bodies)
        return facts._replace(bodies=bodies, scene=_Watched(facts.scene, self))

    def note(self, of: Any, name: str) -> None:
        """Note that an attribute is read."""
        self.starts |= name in STARTS
        self.masses |= name in MASSES or (name == "round" and _depends_on_mass(of.config))


class _Watched:
    """An object like another one, whose attributes are noted where they are such numbers."""

    __slots__ = ("_noted", "_of")

    def __init__(self, of: Any, noted: NumbersRead) -> None:
        self._of, self._noted = of, noted

    def __getattr__(self, name: str) -> Any:
        self._noted.note(self._of, name)
        value = getattr(self._of, name)
        if name in _CONFIGS:
            return tuple(_Watched(one, self._noted) for one in value)
        return _Watched(value, self._noted) if name == "config" and value is not None else value


def _depends_on_mass(config: Any) -> bool:
    """Whether moments may be equal with one mass and not with another, by round-off."""
    inertia = config.inertia
    if inertia is None or max(inertia) - min(inertia) >= _APART * max(inertia):
        return False
    if not isinstance(config.shape, Primitive):
        return True
    # Of equal numbers each mass makes equal ones.
    own = config.shape.homogeneous().moments
    return any(len({*moments}) > 1 for moments in (own, inertia))
