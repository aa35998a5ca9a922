"""Measures of a project's own: typed functions over a log in a file `measures.py`.

    from lavendersim.measures import Trace, own_measure
    from lavendersim.quantities.names import BodyName

    @own_measure
    def highest(trace: Trace, body: BodyName, above: float = 0.0) -> float:
        \"\"\"Greatest height [m] of a body's centre over a level.\"\"\"
        return float(trace.pose[:, trace.bodies.index(body), 2].max()) - above

The function's name is the kind, its parameters are those of the kind, checked by their types. The
file is run where a config beside it names a kind of it, and in the processes that its cells run in.
"""

from __future__ import annotations

import hashlib
import inspect
import linecache
import sys
import traceback
from collections.abc import Callable, Iterable
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any, Final, NamedTuple, TypeVar, get_type_hints

import numpy as np
from pydantic import Field, create_model

from lavendersim.errors import ConfigError, Defect, LavenderError, UsageError
from lavendersim.measures.interfaces import Trace, Value
from lavendersim.measures.specs.base import Measure
from lavendersim.measures.specs.catalogue import KINDS
from lavendersim.measures.specs.own import FILE, FromFile
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Quantity

LARGEST: Final = 1 << 20  # [byte]
Function = TypeVar("Function", bound=Callable[..., Any])
_MARK: Final = "_lavender_own_measure"
# Refused in the words of all numbers of a config, and finite.
_NUMBERS: Final[dict[Any, Any]] = {
    float: Annotated[float, Quantity("")],
    int: Annotated[int, Quantity("", whole=True)],
}


class NoSourceError(UsageError):
    """A measure is of a file that this process may not run."""


class Kind(NamedTuple):
    """A kind of measure that a file defines."""

    function: Callable[..., Any]
    model: type[ConfigModel]  # of its parameters
    meaning: str  # with its unit in brackets


class OwnFile(NamedTuple):
    """A file of measures, run once in this process."""

    path: str  # as it is called in messages
    sha256: str
    kinds: dict[str, Kind]


def own_measure(function: Function) -> Function:
    """Register a function of a file `measures.py` as a kind of measure, by its name.

    Its first parameter is the log (`Trace`); all others have a type. It returns a float or a row of
    numbers; NaN where the log cannot answer.
    """
    setattr(function, _MARK, True)
    return function


def read_own(path: Path, called: str = "") -> OwnFile:
    """Run a file of measures and return its kinds; what this process may run grows by it.

    called: what messages call it; its path, where nothing is given. ConfigError with the line
    where it cannot be run, UsageError where it cannot be read.
    """
    called = called or str(path)
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST + 1)
    except OSError as error:
        raise UsageError(f"{called}: {(error.strerror or str(error)).lower()}") from None
    if len(data) > LARGEST:
        raise UsageError(f"{called}: larger than {LARGEST} bytes")
    try:
        source = data.decode("utf-8")
    except UnicodeDecodeError:
        raise UsageError(f"{called}: not UTF-8") from None
    sha256 = hashlib.sha256(data).hexdigest()
    found = _run(sha256, source, called)
    FromFile.SOURCES[sha256] = source
    return found


def evaluate_own(spec: FromFile, trace: Trace) -> Value:
    """Return a measure of a file; UsageError where this process may not run it."""
    if spec.source is None:
        raise NoSourceError(without_source(spec))
    known = _run(spec.sha256, spec.source, spec.file).kinds
    if spec.function not in known:
        raise UsageError(f"{spec.file}: has no measure {spec.function!r}, as a run of it says")
    kind = known[spec.function]
    given = kind.model.model_validate(_plain(spec.parameters)).model_dump()
    try:
        value = kind.function(trace, **given)
        row = np.asarray(value, dtype=np.float64)
    except LavenderError:
        raise
    except Exception as error:
        line = _line_of(error, spec.sha256)
        what = f"{type(error).__name__}: {error}".rstrip(": ")
        raise UsageError(f"{spec.file}:{line}: {spec.function}: {what}") from error
    if row.ndim > 1:
        what = f"expected a number or a row, found {row.ndim}-D"
        raise UsageError(f"{spec.file}: {spec.function}: {what}")
    return float(row) if row.ndim == 0 else row


def may_measure(measures: Iterable[Measure]) -> bool:
    """Whether none of them is of a file that this process may not run."""
    return all(not isinstance(spec, FromFile) or spec.source is not None for spec in measures)


def check_sources(measures: Iterable[Measure]) -> None:
    """Raise UsageError where a measure is of a file that this process may not run."""
    for spec in measures:
        if isinstance(spec, FromFile) and spec.source is None:
            raise NoSourceError(without_source(spec))


def without_source(spec: FromFile) -> str:
    """Return the sentence for a measure whose file nobody has named."""
    return (
        f"measure {spec.function} is of a file {spec.file} ({spec.sha256[:16]}): no code of a run "
        f"is run; name that file with --measures {spec.file}"
    )


def _plain(parameters: dict[str, Any]) -> dict[str, Any]:
    """Return parameters as a config gives them: lists of what was a tuple come as tuples."""
    return {k: tuple(v) if isinstance(v, list) else v for k, v in parameters.items()}


@lru_cache(maxsize=64)
def _run(sha256: str, source: str, path: str) -> OwnFile:
    name = f"lavender_measures_{sha256[:16]}"
    module = ModuleType(name)
    module.__file__ = path
    sys.modules[name] = module
    try:
        exec(compile(source, _code_name(sha256), "exec"), vars(module))
        kinds = {
            key: _kind_of(key, value)
            for key, value in vars(module).items()
            if getattr(value, _MARK, False) and getattr(value, "__module__", "") == name
        }
    except SyntaxError as error:
        raise ConfigError([Defect(path, error.lineno or 1, error.offset or 1, error.msg)]) from None
    except ConfigError as error:
        raise ConfigError([one._replace(file=path) for one in error.defects]) from None
    except Exception as error:
        what = f"{type(error).__name__}: {error}".rstrip(": ")
        raise ConfigError([Defect(path, _line_of(error, sha256), 1, what)]) from error
    return OwnFile(path, sha256, kinds)


def _code_name(sha256: str) -> str:
    return f"<{FILE} {sha256[:16]}>"


def _line_of(error: BaseException, sha256: str) -> int:
    """Return the last line of the file that an error went through."""
    frames = traceback.extract_tb(error.__traceback__)
    linecache.checkcache()
    lines = [one.lineno for one in frames if one.filename == _code_name(sha256) and one.lineno]
    return lines[-1] if lines else 1


def _kind_of(name: str, function: Callable[..., Any]) -> Kind:
    line = function.__code__.co_firstlineno

    def refuse(sentence: str) -> ConfigError:
        return ConfigError([Defect(FILE, line, 1, f"{name}: {sentence}")])

    if name in KINDS:
        raise refuse("there is a measure of this name already")
    hints = get_type_hints(function, include_extras=True)
    parameters = list(inspect.signature(function).parameters.values())[1:]  # behind the log
    fields: dict[str, Any] = {}
    for one in parameters:
        if one.kind not in (one.POSITIONAL_OR_KEYWORD, one.KEYWORD_ONLY):
            raise refuse(f"{one.name}: expected a parameter that has a name")
        if one.name not in hints:
            raise refuse(f"{one.name}: expected a type, such as {one.name}: float")
        if one.name in {*Measure.model_fields, "kind"}:
            raise refuse(f"{one.name}: every measure has this key already; rename it")
        default = ... if one.default is one.empty else one.default
        hint = _NUMBERS.get(hints[one.name], hints[one.name])
        fields[one.name] = (hint, Field(default=default, description=""))
    model = create_model(name, __base__=ConfigModel, **fields)
    meaning = " ".join((inspect.getdoc(function) or "").split("\n\n")[0].split())
    return Kind(function, model, meaning)
