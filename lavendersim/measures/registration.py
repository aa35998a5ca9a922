"""Registration of measures: the model of a kind's config, and the function that takes its value.

class FirstApex(Measure):            # what a config may say
    kind: Literal["first_apex"]
    ...

@measure(FirstApex)                  # what a log is asked
def first_apex(spec: FirstApex, trace: Trace) -> float:
    ...
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, TypeVar

from lavendersim.measures.interfaces import Trace, Value
from lavendersim.measures.specs.base import Measure

Spec = TypeVar("Spec", bound=Measure)
Returned = TypeVar("Returned", bound=Value)

# The function of each kind of measure, by the model of its config.
FUNCTIONS: Final[dict[type[Measure], Callable[[Any, Trace], Value]]] = {}


def measure(
    model: type[Spec],
) -> Callable[[Callable[[Spec, Trace], Returned]], Callable[[Spec, Trace], Returned]]:
    """Register the decorated function as what takes a kind of measure from a log.

    It returns a float or a row of numbers; NaN where the log cannot answer.
    """

    def register(function: Callable[[Spec, Trace], Returned]) -> Callable[[Spec, Trace], Returned]:
        if FUNCTIONS.setdefault(model, function) is not function:
            raise ValueError(f"{model.__name__} has a function already")
        return function

    return register
