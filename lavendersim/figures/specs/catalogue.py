"""The `figure` section of a config, and all kinds of panels: of this package, and of others.

Every model of a panel in a file of `lavendersim/figures/specs` is one. Another distribution adds
its own by an entry point of the group `lavendersim.figures` whose value is a module:

    [project.entry-points."lavendersim.figures"]
    cumulative = "my_package.cumulative"

The module has the model of each of its kinds and the function that draws it, see
`lavendersim.figures.registration`; it is imported with every config, so it imports matplotlib
where it draws.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from pydantic import Field

from lavendersim.figures import specs
from lavendersim.figures.specs.base import Panel
from lavendersim.quantities.chosen_kind import one_of
from lavendersim.quantities.kinds import all_kinds
from lavendersim.quantities.model import ConfigModel

GROUP: Final = "lavendersim.figures"
KINDS: Final = all_kinds(Panel, specs, GROUP)

if TYPE_CHECKING:
    PanelSpec = Panel
else:
    PanelSpec = one_of(KINDS)


class FigureSpec(ConfigModel):
    """Panels and the caption beneath them."""

    caption: str = Field(min_length=1, description="what to see, in one or two sentences")
    panels: tuple[PanelSpec, ...] = Field(
        min_length=1, max_length=6, description="left to right; more than three in two rows"
    )
