"""Numbers of a config: SI quantities with unit and bounds as field types, and words for them."""

from lavendersim.quantities.found import found, near, nearest, quoted
from lavendersim.quantities.model import ConfigModel, ResolvedModel
from lavendersim.quantities.names import (
    AxisName,
    BodyName,
    MeasureName,
    NewName,
    PlaneName,
    SurfaceName,
)
from lavendersim.quantities.quantity import (
    AngularVelocity,
    BoxSize,
    Direction,
    Position,
    Quantity,
    Quaternion,
    Vector,
    Vector3,
    Velocity,
    either,
    refusal,
    sentence_error,
)
from lavendersim.quantities.scalars import Ratio, exact, label

__all__ = [
    "AngularVelocity",
    "AxisName",
    "BodyName",
    "BoxSize",
    "ConfigModel",
    "Direction",
    "MeasureName",
    "NewName",
    "PlaneName",
    "Position",
    "Quantity",
    "Quaternion",
    "Ratio",
    "ResolvedModel",
    "SurfaceName",
    "Vector",
    "Vector3",
    "Velocity",
    "either",
    "exact",
    "found",
    "label",
    "near",
    "nearest",
    "quoted",
    "refusal",
    "sentence_error",
]
