"""The shapes of a config as written, and how a body or a part of one is turned.

Every shape has a frame of its own. Of a hull and of a compound only its axes count: the body stands
where its centre of mass stands.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal, Union

from pydantic import Field, GetJsonSchemaHandler
from pydantic_core import CoreSchema

from lavendersim.cell.shapes import PRIMITIVES, Bowl, Drum, Plane, Primitive
from lavendersim.experiment.models.meshes import HeightField, Mesh
from lavendersim.quantities.chosen_kind import ByKind
from lavendersim.quantities.kinds import kind_of
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import (
    Direction,
    Either,
    Position,
    Quantity,
    Vector,
    Vector3,
)


class OrName:
    """Lets an editor take a name of `scene.shapes` where a shape is expected.

    A name is replaced by its shape before a config is validated (`resolve.named_shapes`).
    """

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Describe the shape, or a name."""
        return {"anyOf": [handler(schema), {"type": "string"}]}


MOST_POINTS = 256  # of a hull: features of contacts are counted in eight bits
MOST_PARTS = 256


class Polyhedral(ConfigModel):
    """A convex polyhedron: after resolving it is a hull in its principal frame."""

    @abstractmethod
    def corners(self) -> tuple[Vector3, ...]:
        """Return points [m] whose convex hull it is, in a frame whose axes are the body's."""


class Hull(Polyhedral):
    """The convex hull of points; those inside of it count for nothing."""

    kind: Literal["hull"]
    points: tuple[Position, ...] = Field(
        min_length=4,
        max_length=MOST_POINTS,
        description="[m] in a frame whose axes are the body's; only differences count",
    )

    def corners(self) -> tuple[Vector3, ...]:
        """Return the points [m]."""
        return self.points


# Shapes that bodies and parts of compounds may have; the order is that of messages.
SIMPLE: Final[tuple[type[Primitive | Polyhedral], ...]] = (
    *PRIMITIVES,
    Hull,
)
KINDS: Final = tuple(kind_of(model) for model in SIMPLE)
SOLIDS: Final = (*KINDS, "compound")  # all but planes, cavities and surfaces
CAVITIES: Final = tuple(kind_of(model) for model in (Bowl, Drum))
SURFACES: Final = tuple(kind_of(model) for model in (Mesh, HeightField))
# Those whose principal axes are not those of their frame.
TURNED: Final = tuple(kind for kind in SOLIDS if kind not in map(kind_of, PRIMITIVES))

if TYPE_CHECKING:
    Simple = Primitive | Polyhedral
else:
    Simple = Union[SIMPLE]  # noqa: UP007


class AxisAngle(ConfigModel):
    """A rotation by an angle about an axis."""

    axis: Direction = Field(description="axis of rotation, world frame; is normalised")
    degrees: Annotated[float, Quantity("degree")] = Field(description="[degree] right-handed angle")


Orientation = Annotated[
    Annotated[tuple[float, float, float, float], Vector(4, Quantity(), nonzero=True)] | AxisAngle,
    Either("a quaternion [w, x, y, z] or {axis: [x, y, z], degrees: angle}", tuple, dict),
]


class Part(ConfigModel):
    """One convex piece of a compound."""

    shape: Annotated[Simple, ByKind()] = Field(
        description=f"{', '.join(KINDS[:-1])} or {KINDS[-1]}"
    )
    position: Position = Field(
        default=(0.0, 0.0, 0.0), description="[m] of its centre of mass, in the compound's frame"
    )
    orientation: Orientation = Field(
        default=(1.0, 0.0, 0.0, 0.0),
        description="part to compound: quaternion w x y z, or `{axis, degrees}`; both are "
        "normalised",
    )


class Compound(ConfigModel):
    """Several shapes that move as one body; where parts overlap, their mass counts twice."""

    kind: Literal["compound"]
    parts: tuple[Part, ...] = Field(
        min_length=1,
        max_length=MOST_PARTS,
        description="share the mass by their volumes; their frame's axes are the body's",
    )


if TYPE_CHECKING:
    Solid = Primitive | Polyhedral | Compound
    Shape = Plane | Primitive | Polyhedral | Compound | Bowl | Drum | Mesh | HeightField
else:
    Solid = Union[(*SIMPLE, Compound)]
    Shape = Annotated[
        Union[(Plane, Solid, Bowl, Drum, Mesh, HeightField)],  # noqa: UP007
        ByKind(),
        OrName(),
    ]
