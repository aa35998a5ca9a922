"""All kinds of measures that a config may name: those of this package, and those of others.

Every model of a measure in a file of `lavendersim/measures/specs` is one. Another distribution adds
its own by an entry point of the group `lavendersim.measures` whose value is a module:

    [project.entry-points."lavendersim.measures"]
    bounce = "my_package.bounce"

The module has the model and the function of each of its kinds, see
`lavendersim.measures.registration`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from lavendersim.measures import specs
from lavendersim.measures.specs.base import Measure
from lavendersim.quantities.chosen_kind import one_of
from lavendersim.quantities.kinds import all_kinds

GROUP: Final = "lavendersim.measures"
KINDS: Final = all_kinds(Measure, specs, GROUP)

if TYPE_CHECKING:
    MeasureSpec = Measure
else:
    MeasureSpec = one_of(KINDS)
