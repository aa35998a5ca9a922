"""The section `study`: a deliberate error, for teaching and for negative controls of the checks.

    study: {mistake: capture_in_sweeps}

A negative control shows that a check sees the error. A mistake is part of no preset and of no other
section, and every run that makes one says so: `lavender plan`, `run`, `check` and `show`, and the
metadata of its log.
"""

from __future__ import annotations

from typing import Final

from pydantic import Field

from lavendersim.cell.choices import CAPTURE_IN_SWEEPS, NO_MISTAKE, Mistake
from lavendersim.experiment.text.place import Place
from lavendersim.quantities.model import ConfigModel

# What the numerics must specify for a mistake to be one: key, value, and why.
_PLACES: Final = {
    CAPTURE_IN_SWEEPS: (
        ("solver", "projected_gauss_seidel", "is a mistake in the loop of projected_gauss_seidel"),
        ("impacts", "captured", "is a mistake of captured restitution"),
    )
}


class Study(ConfigModel):
    """A deliberate error; for teaching and for negative controls alone."""

    mistake: Mistake = Field(
        default=NO_MISTAKE,
        description="`capture_in_sweeps`: every sweep captures restitution anew, from the velocity "
        "that it finds, and the bounce is lost",
    )

    @classmethod
    def rules(cls, at: Place) -> None:
        """The numerics have a place for the mistake."""
        mistake = at.get("mistake")
        for key, expected, why in _PLACES.get(mistake.text or "", ()):
            value = at.root.get("numerics", key)
            if value.text in (None, expected):
                continue  # no text is refused elsewhere
            sentence = f"mistake: {mistake.text} {why}; expected {key}: {expected}"
            at.refuse_pair(mistake, value, f"{sentence}, found {value.text}")
