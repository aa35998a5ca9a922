"""Measures that are typed functions over a log, of a file `measures.py` or of another package.

    @own_measure
    def highest(trace: Trace, body: BodyName, above: float = 0.0) -> float:
        \"\"\"Greatest height [m] of a body's centre over a level.\"\"\"
        return float(trace.pose[:, trace.bodies.index(body), 2].max()) - above

The function's name is the kind, its parameters behind the log are those of the kind, checked by
their types; the first sentence of its docstring is the meaning, with the unit in brackets.
"""

from __future__ import annotations

import inspect
import linecache
import traceback
from collections.abc import Callable, Mapping
from typing import Annotated, Any, Final, Literal, NamedTuple, TypeVar, get_type_hints

import numpy as np
from pydantic import Field, create_model

from lavendersim.errors import ConfigError, Defect, LavenderError, UsageError
from lavendersim.measures.interfaces import Trace, Value
from lavendersim.measures.registration import measure
from lavendersim.measures.specs.base import Measure
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Quantity

Function = TypeVar("Function", bound=Callable[..., Any])
_KIND: Final = "_lavender_own_measure"
# Refused in the words of all numbers of a config, and finite.
_NUMBERS: Final[dict[Any, Any]] = {
    float: Annotated[float, Quantity("")],
    int: Annotated[int, Quantity("", whole=True)],
}


class Kind(NamedTuple):
    """A kind of measure that a typed function is."""

    function: Callable[..., Any]
    model: type[ConfigModel]  # of its parameters
    meaning: str  # with its unit in brackets

    def refusal(self, sentence: str) -> ConfigError:
        """Return the error that refuses the function, at its line."""
        return _refusal(self.function, sentence)


def own_measure(function: Function) -> Function:
    """Register a function as a kind of measure, by its name.

    It stands in a file `measures.py` beside a config, or in a module that an entry point of the
    group `lavendersim.measures` names. Its first parameter is the log (`Trace`); all others have a
    type. It returns a float or a row of numbers; NaN where the log cannot answer.
    """
    kind = _kind_of(function)
    setattr(function, _KIND, kind)
    _declare(kind, function.__globals__)
    return function


def kind_of(value: Any) -> Kind | None:
    """Return the kind that a function was registered as; None of all else."""
    found = getattr(value, _KIND, None)
    return found if isinstance(found, Kind) else None


def take(kind: Kind, trace: Trace, given: Mapping[str, Any], called: str) -> Value:
    """Return what a function takes from a log; UsageError with its line where it fails.

    called: what messages call the file of the function.
    """
    name = kind.function.__name__
    try:
        row = np.asarray(kind.function(trace, **given), dtype=np.float64)
    except LavenderError:
        raise
    except Exception as error:
        line = line_of(error, kind.function.__code__.co_filename)
        what = f"{type(error).__name__}: {error}".rstrip(": ")
        raise UsageError(f"{called}:{line}: {name}: {what}") from error
    if row.ndim > 1:
        raise UsageError(f"{called}: {name}: expected a number or a row, found {row.ndim}-D")
    return float(row) if row.ndim == 0 else row


def line_of(error: BaseException, file: str) -> int:
    """Return the last line of a file that an error went through."""
    frames = traceback.extract_tb(error.__traceback__)
    linecache.checkcache()
    lines = [one.lineno for one in frames if one.filename == file and one.lineno]
    return lines[-1] if lines else 1


def _refusal(function: Callable[..., Any], sentence: str) -> ConfigError:
    code = function.__code__
    message = f"{function.__name__}: {sentence}"
    return ConfigError([Defect(code.co_filename, code.co_firstlineno, 1, message)])


def _kind_of(function: Callable[..., Any]) -> Kind:
    hints = get_type_hints(function, include_extras=True)
    parameters = list(inspect.signature(function).parameters.values())[1:]  # behind the log
    fields: dict[str, Any] = {}
    for one in parameters:
        if one.kind not in (one.POSITIONAL_OR_KEYWORD, one.KEYWORD_ONLY):
            raise _refusal(function, f"{one.name}: expected a parameter that has a name")
        if one.name not in hints:
            raise _refusal(function, f"{one.name}: expected a type, such as {one.name}: float")
        if one.name in {*Measure.model_fields, "kind"}:
            raise _refusal(function, f"{one.name}: every measure has this key already; rename it")
        default = ... if one.default is one.empty else one.default
        hint = _NUMBERS.get(hints[one.name], hints[one.name])
        fields[one.name] = (hint, Field(default=default, description=""))
    model = create_model(function.__name__, __base__=ConfigModel, **fields)
    meaning = " ".join((inspect.getdoc(function) or "").split("\n\n")[0].split())
    return Kind(function, model, meaning)


def _declare(kind: Kind, module: dict[str, Any]) -> None:
    """Put the model of the kind into its module, where kinds of packages and pickles are found."""
    function = kind.function
    name = "".join(word.capitalize() for word in function.__name__.split("_")) + "Measure"
    if name in module:
        raise kind.refusal(f"its model is {name}, of which the module has one already")
    bases: Any = (Measure, kind.model)
    chosen_by: dict[str, Any] = {"kind": (Literal[function.__name__], ...)}
    model: type[Measure] = create_model(
        name,
        __base__=bases,
        __module__=function.__module__,
        __doc__=kind.meaning,
        **chosen_by,
    )

    def taken(spec: Measure, trace: Trace) -> Value:
        given = {key: getattr(spec, key) for key in kind.model.model_fields}
        return take(kind, trace, given, function.__code__.co_filename)

    measure(model)(taken)
    module[name] = model
