"""Model of the measure that compares every logged contact with the laws of contact."""

from __future__ import annotations

from typing import Literal

from lavendersim.measures.specs.base import Measure
from lavendersim.quantities.readings import CONTACTS


class Optimality(Measure):
    """The largest violation [m/s] of each contact law in any logged contact (a row of numbers).

    1 pushing, lambda_n >= 0; 2 complementarity of lambda_n and v_n + b + gamma lambda_n;
    where there is friction also 3 the cone, |lambda_t| <= mu lambda_n; 4 sliding opposes motion.
    Numbers 2 and 4 are what exceeds the residual of their step. Impulses count in the velocity they
    give: times the inverse effective mass, or the sum of the inverse masses.
    """

    READS = CONTACTS
    NO_NUMBER = "the log has no contacts"
    kind: Literal["optimality"]
