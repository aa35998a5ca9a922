"""The `surface_pairs` of a scene as written: what holds between two named surfaces, unmixed."""

from __future__ import annotations

from typing import Final

from pydantic import Field

from lavendersim.cell.surface import PairProperties
from lavendersim.experiment.text.node import Node
from lavendersim.experiment.text.place import Place
from lavendersim.quantities.found import quoted
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import SurfaceName

SURFACE_PAIRS: Final = ("scene", "surface_pairs")


class _Between(ConfigModel):
    between: tuple[SurfaceName, ...] = Field(
        min_length=2,
        max_length=2,
        description="names of two of `scene.surfaces`, in any order; one name twice: two alike",
    )


class SurfacePair(PairProperties, _Between):
    """What holds where two named surfaces touch, in place of what mixing makes of them."""

    @classmethod
    def rules(cls, at: Place) -> None:
        """It says something, of two surfaces that no pair before it says something of."""
        super().rules(at)
        unknown = at.node.incomplete or at.node.entries.keys() - cls.model_fields.keys()
        if not unknown and not any(at.written(key) for key in PairProperties.model_fields):
            at.refuse(at.node.mark, f"{at} has no property; expected one such as friction")
        name = str(at.path[-1])
        own = between(at.node)
        for other, pair in at.root.get(*SURFACE_PAIRS).entries.items():
            if other == name:
                return
            if len(own) == 2 and own == between(pair):
                one, two = own
                sentence = f"{quoted(one)} and {quoted(two)} stand in {other}; keep one pair"
                at.refuse(at.get("between").mark, f"between: {sentence}")


def between(pair: Node) -> tuple[str, ...]:
    """Return the names of the two surfaces of a pair as written, sorted: its order says nothing."""
    names = [node.text for node in pair.get("between").items]
    return tuple(sorted(name for name in names if name is not None))


def paired(root: Node, surface: str) -> str | None:
    """Return the name of the first pair that a surface stands in; None where it stands in none."""
    pairs = root.get(*SURFACE_PAIRS).entries.items()
    return next((name for name, pair in pairs if surface in between(pair)), None)
