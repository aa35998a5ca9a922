"""Whether a plan depends on how bodies start: the facts of a scene, noting what is read of them.

A decision is a function of what it reads. Where none of them read where a body starts or how fast,
each comes out the same for every scene that differs in that alone, and need not be made again.
"""

from __future__ import annotations

from typing import Any, Final

from lavendersim.engine.effects import Facts

# Of a body as predicates see it and of its config; of a scene, what leads to its bodies.
STARTS: Final = frozenset({"position", "release", "velocity", "speed", "bodies"})


class StartsRead:
    """Notes whether how a body starts was read of the facts that it watches."""

    def __init__(self) -> None:
        self.any: bool | None = None  # None: nothing has been watched

    def watched(self, facts: Facts) -> Facts:
        """Return the facts with bodies and scene that note what is read of them."""
        self.any = False
        bodies: Any = tuple(_Watched(body, self) for body in facts.bodies)
        return facts._replace(bodies=bodies, scene=_Watched(facts.scene, self))


class _Watched:
    """An object like another one, whose attributes are noted where they say how a body starts."""

    __slots__ = ("_noted", "_of")

    def __init__(self, of: Any, noted: StartsRead) -> None:
        self._of, self._noted = of, noted

    def __getattr__(self, name: str) -> Any:
        if name in STARTS:
            self._noted.any = True
        value = getattr(self._of, name)
        return _Watched(value, self._noted) if name == "config" and value is not None else value
