"""The `study` section of a config in; which known mistake is made on purpose out.

    study: {mistake: capture_in_sweeps}

For teaching, and for negative controls that show that a check sees it. A mistake is part of no
preset and of no other section, and every run that makes one says so: `lavender plan`, `run`,
`check` and `show`, and the metadata of its log.
"""

from __future__ import annotations

from pydantic import Field

from lavendersim.cell.choices import NO_MISTAKE, Mistake
from lavendersim.quantities.model import ConfigModel


class Study(ConfigModel):
    """What is done wrong on purpose; for teaching and for negative controls alone."""

    mistake: Mistake = Field(
        default=NO_MISTAKE,
        description="a known mistake that is made on purpose; capture_in_sweeps: restitution is "
        "captured anew in every sweep, not once before the solve, and the bounce is lost",
    )
