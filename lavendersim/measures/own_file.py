"""Measures of a project's own: typed functions over a log in a file `measures.py`.

A function of it that `own_measure` registers is a kind of measure: see `typed_functions`. The file
is run where a config beside it names a kind of it, and in the processes that its cells run in.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any, Final, NamedTuple

from lavendersim.errors import ConfigError, Defect, UsageError
from lavendersim.measures.interfaces import Trace, Value
from lavendersim.measures.specs.base import Measure
from lavendersim.measures.specs.catalogue import KINDS
from lavendersim.measures.specs.own import FILE, FromFile
from lavendersim.measures.typed_functions import Kind, kind_of, line_of, take

LARGEST: Final = 1 << 20  # [byte]
TAKEN: Final = "there is a measure of this name already"


class NoSourceError(UsageError):
    """A measure is of a file that this process may not run."""


class OwnFile(NamedTuple):
    """A file of measures, run once in this process."""

    path: str  # as it is called in messages
    sha256: str
    kinds: dict[str, Kind]


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
    return take(kind, trace, given, spec.file)


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
            key: kind
            for key, value in vars(module).items()
            if (kind := kind_of(value)) and getattr(value, "__module__", "") == name
        }
        if taken := [kind.refusal(TAKEN) for key, kind in kinds.items() if key in KINDS]:
            raise taken[0]
    except SyntaxError as error:
        raise ConfigError([Defect(path, error.lineno or 1, error.offset or 1, error.msg)]) from None
    except ConfigError as error:
        raise ConfigError([one._replace(file=path) for one in error.defects]) from None
    except Exception as error:
        what = f"{type(error).__name__}: {error}".rstrip(": ")
        raise ConfigError([Defect(path, line_of(error, _code_name(sha256)), 1, what)]) from error
    return OwnFile(path, sha256, kinds)


def _code_name(sha256: str) -> str:
    return f"<{FILE} {sha256[:16]}>"
