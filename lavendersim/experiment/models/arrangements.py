"""Arrangements as written: one body in many places, by a few numbers instead of a list."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, GetJsonSchemaHandler
from pydantic_core import CoreSchema

from lavendersim.experiment.models.bodies import ArrangedBody
from lavendersim.experiment.models.tree import MOST_BODIES
from lavendersim.experiment.text.place import Place
from lavendersim.quantities.chosen_kind import ByKind
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Direction, Position, Quantity, Vector, Vector3

Count = Annotated[int, Quantity(whole=True, minimum=1, maximum=MOST_BODIES)]
Gap = Annotated[float, Quantity("m", minimum=0)]
_Spacing = Annotated[float, Quantity("m", above=0)]
SpacingOf = _Spacing | tuple[_Spacing, ...]


class AnyMapping:
    """Lets an editor take any mapping: what `first` lacks is that of `body`."""

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Describe the mapping."""
        return {"type": "object"}


class _Arranged(ConfigModel):
    """What stands in the places of an arrangement."""

    body: ArrangedBody = Field(description="what stands in each place")
    first: Annotated[ArrangedBody, AnyMapping()] | None = Field(
        default=None,
        description="keys by which the first body differs, such as `{velocity: [1, 0, 0]}`; the "
        "rest is that of `body`, and so are the places",
    )


class Tower(_Arranged):
    """Bodies one on the other along z, numbered from the lowest."""

    kind: Literal["tower"]
    count: Count = Field(description="number of bodies")
    base: Position = Field(
        default=(0.0, 0.0, 0.0),
        description="[m] x and y of all centres, z of the lowest point of the lowest body",
    )
    gap: Gap = Field(default=0.0, description="[m] between one body and the next above it")


class Pyramid(_Arranged):
    """Rows along x, each one body shorter than the row below and half a place further in.

    Numbered row by row from the lowest, in x.
    """

    kind: Literal["pyramid"]
    base_count: Annotated[int, Quantity(whole=True, minimum=1, maximum=400)] = Field(
        description="n, bodies of the lowest row; n (n + 1)/2 in all"
    )
    base: Position = Field(
        default=(0.0, 0.0, 0.0),
        description="[m] middle of the lowest row, z of its lowest point",
    )
    gap: Gap = Field(default=0.0, description="[m] between neighbours of a row")


class Grid(_Arranged):
    """Bodies in columns, rows and layers, numbered along x, then y, then z."""

    kind: Literal["grid"]
    counts: Annotated[
        tuple[int, int, int], Vector(3, Quantity(whole=True, minimum=1, maximum=MOST_BODIES))
    ] = Field(description="number of bodies along x, y, z")
    spacing: Annotated[Vector3, Vector(3, Quantity("m", above=0))] = Field(
        description="[m] from centre to centre along x, y, z"
    )
    origin: Position = Field(
        default=(0.0, 0.0, 0.0), description="[m] centre of mass of the first body"
    )
    jitter: Annotated[float, Quantity("m", minimum=0)] = Field(
        default=0.0,
        description="[m] every centre is moved by up to so much along each axis, evenly drawn "
        "(Python's Mersenne twister)",
    )
    seed: Annotated[int, Quantity(whole=True, minimum=0, maximum=2**53)] = Field(
        default=0, description="of the jitter: equal seeds give equal scenes"
    )


class Row(_Arranged):
    """Bodies along a line, numbered along it."""

    kind: Literal["row"]
    count: Count = Field(description="number of bodies")
    origin: Position = Field(
        default=(0.0, 0.0, 0.0), description="[m] centre of mass of the first body"
    )
    along: Direction = Field(
        default=(1.0, 0.0, 0.0), description="direction of the line; is normalised"
    )
    gap: Gap | None = Field(
        default=None, description="[m] between neighbours, by their extents along the line; none: 0"
    )
    spacing: SpacingOf | None = Field(
        default=None,
        description="[m] instead of a gap, from centre to centre: a number, or a list of one for "
        "each two neighbours",
    )

    @classmethod
    def rules(cls, at: Place) -> None:
        """A gap or a spacing; a list of spacings has one for each two neighbours."""
        at.refuse_both(("gap", "spacing"))
        listed, count = at.get("spacing").items, at.get("count").number
        if listed and count is not None and len(listed) != count - 1:
            expected = f"expected {count - 1:g} numbers, one for each two neighbours"
            at.refuse(at.get("spacing").mark, f"spacing: {expected}, found {len(listed)}")


class Ring(_Arranged):
    """Bodies on a circle, numbered by the right-handed angle about its axis."""

    kind: Literal["ring"]
    count: Count = Field(description="number of bodies")
    centre: Position = Field(default=(0.0, 0.0, 0.0), description="[m] of the circle")
    radius: Annotated[float, Quantity("m", above=0)] = Field(
        description="[m] from the centre to the bodies' centres of mass"
    )
    axis: Direction = Field(
        default=(0.0, 0.0, 1.0), description="of the circle; is normalised. z: angles count from x"
    )
    start_degrees: Annotated[float, Quantity("degree")] = Field(
        default=0.0, description="[degree] angle of the first body"
    )
    turned: bool = Field(
        default=False,
        description="true: each body and its velocities are turned by its angle about the axis",
    )


class Rack(_Arranged):
    """A triangle in the x-y plane with its tip towards -x, each row one body longer, as in pool.

    Numbered row by row from the tip, in y. Neighbours stand at the corners of equal triangles.
    """

    kind: Literal["rack"]
    rows: Annotated[int, Quantity(whole=True, minimum=1, maximum=400)] = Field(
        description="n, bodies of the last row; n (n + 1)/2 in all"
    )
    tip: Position = Field(
        default=(0.0, 0.0, 0.0), description="[m] centre of mass of the first body"
    )
    gap: Gap = Field(default=0.0, description="[m] between neighbours of a row")


Arrangement = Annotated[Tower | Pyramid | Grid | Row | Ring | Rack, ByKind()]
