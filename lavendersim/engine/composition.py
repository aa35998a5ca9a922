"""What engines are composed of, by names alone: kernels, and what a solver keeps of a contact.

To compose an engine loads numba and a hundred modules of kernels, which takes longer than all else
that `lavender plan` does. What is found is kept beside the compiled kernels, under the plan and the
hash of every engine source.
"""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from . import kernel_store
from .kernel_store import NAMES
from .sources import source_hash
from .spec import Spec


class Composition(NamedTuple):
    """Names of what an engine is composed of."""

    kernels: dict[str, list[str]]  # by module of the engine
    solver_columns: list[str]  # of the contact record


_known: dict[Spec, Composition] = {}
_asked: list[set[Spec]] = []  # since `kept` was entered


def composition_of(spec: Spec) -> Composition:
    """Return what an engine of `spec` is composed of; nothing is compiled."""
    for asked in _asked:
        asked.add(spec)
    if spec not in _known:
        from .solvers.catalogue import SOLVERS  # late: numba
        from .step import kernels_of

        columns = [name for name, _ in SOLVERS[spec.solver].contact_fields]
        _known[spec] = Composition(kernels_of(spec), columns)
    return _known[spec]


@contextmanager
def kept(spec: Spec) -> Iterator[None]:
    """Take from disk what is asked for inside about a plan, and about plans like it, or keep it."""
    path = _path(spec)
    payload = kernel_store.read(path) if path.name else None
    before: dict[Spec, Composition] = pickle.loads(payload) if payload else {}
    _known.update(before)
    asked: set[Spec] = set()
    _asked.append(asked)
    try:
        yield
    finally:
        _asked.pop()
    if path.name and not asked <= before.keys():
        known = {one: _known[one] for one in sorted(asked)}
        kernel_store.write(path, pickle.dumps(before | known))


def _path(spec: Spec) -> Path:
    """Return the file of a plan; nothing where nothing can be kept."""
    folder = kernel_store.directory()[0]
    key = hashlib.sha256(repr(spec).encode()).hexdigest()[:24]
    return folder / f"{key}-{source_hash()[:8]}{NAMES}" if folder.name else Path()
