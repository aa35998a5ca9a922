"""Two runs against each other: configs, versions, measures, verdicts, cost, states to the bit.

    pairing -> configs, environments, measures -> Comparison -> text or JSON
            -> states

Cells are paired by their coordinates. Times (of the machine, and what a step takes) are reported
and make no run different.
"""

from lavendersim.comparison.compare import Comparison, compare

__all__ = ["Comparison", "compare"]
