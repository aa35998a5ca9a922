"""The rule between measures: what is of other measures stands below them, so none is of itself."""

from __future__ import annotations

from lavendersim.experiment.text.place import Place
from lavendersim.measures.specs.arithmetic import OPERANDS, OfMeasures
from lavendersim.measures.specs.catalogue import KINDS
from lavendersim.quantities.found import quoted


def measure_rules(at: Place) -> None:
    """Refuse a measure of one that does not stand above it."""
    measures = at.get("measure").entries
    above: list[str] = []
    for name, node in measures.items():
        kind = node.get("kind").text
        if kind in KINDS and issubclass(KINDS[kind], OfMeasures):
            for key in OPERANDS:
                operand = node.get(key)
                if operand.text in measures and operand.text not in above:
                    sentence = f"{key}: expected a measure above {quoted(name)}"
                    at.refuse(operand.mark, f"{sentence}, found {quoted(operand.text)}")
        above.append(name)
