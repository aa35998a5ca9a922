"""A decorator: measures and checks of states that are infinite or NaN, without numpy's warnings.

A run may end beyond all numbers, which is a result. A sum over its states is infinite or NaN then,
and is judged as such; what numpy would say of it to a person is of no use.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

import numpy as np

Given = ParamSpec("Given")
Result = TypeVar("Result")


def without_warnings(function: Callable[Given, Result]) -> Callable[Given, Result]:
    """Let a function work with numbers that are not finite, as kernels do."""

    @wraps(function)
    def called(*given: Given.args, **named: Given.kwargs) -> Result:
        with np.errstate(all="ignore"):
            return function(*given, **named)

    return called
