"""The rules between claims: measures are of those above them, expectations have own names."""

from __future__ import annotations

from lavendersim.experiment.text.node import Mark
from lavendersim.experiment.text.place import Place
from lavendersim.measures.specs.always import CHECKS, COMPLETES, DIVERGES, NONE
from lavendersim.measures.specs.arithmetic import OPERANDS, OfMeasures
from lavendersim.measures.specs.catalogue import KINDS
from lavendersim.quantities.found import nearest, quoted


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


def expectation_rules(at: Place) -> None:
    """Refuse a name that stands twice, and what must fail but does not exist or is two things."""
    first: dict[str, Mark] = {}
    for item in at.get("expect").items:
        name = item.get("name")
        if name.text is None:
            continue
        if name.text in first:
            line = first[name.text].line
            sentence = f"name: {quoted(name.text)} is the name of another expectation, line {line}"
            at.refuse(name.mark, sentence)
        first.setdefault(name.text, name.mark)
    _control_rules(at)


def _control_rules(at: Place) -> None:
    items, always = at.get("expect").items, at.get("always")
    names = [item.get("name").text for item in items if not item.get("fails")]
    claims = [name for name in names if name is not None]
    checks = [COMPLETES, DIVERGES]
    if always:
        checks += [check for check in CHECKS if always.get(check).text != NONE]
    for item in items:
        fails = item.get("fails")
        if fails.text is None:
            continue
        called = quoted(fails.text)
        if fails.text in claims and fails.text in checks:
            sentence = f"{called} is an expectation and a check; rename the first"
            at.refuse(fails.mark, f"fails: {sentence}")
        elif fails.text not in claims and fails.text not in checks:
            hint = nearest(fails.text, [*checks, *claims])
            at.refuse(fails.mark, f"fails: no expectation or check is called {called}{hint}")
