"""What a body's surface does in a contact: restitution, compliance and friction coefficients."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Quantity


class Surface(ConfigModel):
    """What a body's surface does in a contact; a property that is not specified is 0.

    In a contact of two surfaces friction is the geometric mean sqrt(mu_a mu_b), so that a
    frictionless surface stays frictionless; compliances add (two springs in series); restitution,
    torsional and rolling friction are the larger of the two.
    """

    restitution: Annotated[float, Quantity(minimum=0, maximum=1)] = Field(
        default=0.0,
        description="share of the approach speed given back, 0 to 1; a pair takes the larger",
    )
    compliance: Annotated[float, Quantity("m/N", minimum=0)] = Field(
        default=0.0, description="[m/N] indentation per force; the two surfaces of a contact add"
    )
    friction: Annotated[float, Quantity(minimum=0)] = Field(
        default=0.0,
        description="Coulomb coefficient mu; a pair takes the geometric mean sqrt(mu_a mu_b)",
    )
    torsional_friction: Annotated[float, Quantity("m", minimum=0)] = Field(
        default=0.0,
        description="[m] torque about the normal per normal force; a pair takes the larger",
    )
    rolling_friction: Annotated[float, Quantity("m", minimum=0)] = Field(
        default=0.0,
        description="[m] torque against rolling per normal force; a pair takes the larger",
    )
