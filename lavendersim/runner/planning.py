"""The cells of a sweep built, planned and named, in shares of several processes.

Of a short cell that takes as long as all that its process does with it after the run. A process
sends back the configs that it built, what it decided for its share, and the names of the logs; what
holds for all cells, their shared plans, is made of the parts here. Plans and names are the same for
any number of processes.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from typing import Final, NamedTuple

from lavendersim.cell import CellConfig
from lavendersim.experiment.cell import Cell
from lavendersim.peers.catalogue import installed_version, peer_of
from lavendersim.scene.plan import Plan

from .forking import may_fork
from .interruption import handled
from .plans import Decided, decided, joined
from .workers import Death, work

# Cells below which one process plans: another one takes 0.05 s, and a cell a quarter millisecond.
WORTH_PROCESSES: Final = 2_000
SHARES: Final = 4  # of each process, so that none waits long for the other
MOST_OF_SHARE: Final = 2_000  # cells: what comes back of them is in memory twice


class Planned(NamedTuple):
    """What cells are run by."""

    plans: list[Plan]
    logs: list[str]  # name of each cell's log


class _Share(NamedTuple):
    cells: Sequence[Cell]
    source: str  # digest of the engine


class _Found(NamedTuple):
    """What a process found of its share."""

    configs: list[CellConfig | None]  # of cells that were built here; none where one has no plan
    decided: Decided
    logs: list[str]


def planned(cells: Sequence[Cell], source: str, workers: int) -> Planned:
    """Return the plan of each cell and the name of its log; cells keep their configs.

    source: digest of the engine. Raises ConfigError where a cell has no plan, see `shared_plans`.
    """
    if are_shared(cells, workers):
        size = min(-(-len(cells) // (SHARES * workers)), MOST_OF_SHARE)
        firsts = range(0, len(cells), size)
        shares = {first: _Share(cells[first : first + size], source) for first in firsts}
        parts = _by_others(shares, workers)
    else:
        parts = [_found(_Share(cells, source))]
    plans = joined([part.decided for part in parts])
    return Planned(plans, [log for part in parts for log in part.logs])


def are_shared(cells: Sequence[Cell], workers: int) -> bool:
    """Whether so many processes plan these cells, and build them."""
    return workers > 1 and len(cells) >= WORTH_PROCESSES and may_fork()


def _by_others(shares: dict[int, _Share], workers: int) -> list[_Found]:
    """Return what other processes found of each share, in the order of the cells."""
    places = {id(share): first for first, share in shares.items()}
    found: dict[int, _Found] = {}
    with handled():  # a signal ends these processes before this one
        for share, part in work(_found, list(shares.values()), workers):
            if isinstance(part, Death):
                part = _found(share)
            found[places[id(share)]] = part
            for cell, config in zip(share.cells, part.configs, strict=False):
                if config is not None:
                    cell.keep(config)
    return [found[first] for first in shares]


def _found(share: _Share) -> _Found:
    known = [cell.is_built for cell in share.cells]
    decisions = decided(share.cells)
    if decisions.defects:
        return _Found([], decisions, [])
    logs = [log_of(cell, share.source) for cell in share.cells]
    built = zip(share.cells, known, strict=True)
    return _Found([None if before else cell.config for cell, before in built], decisions, logs)


def log_of(cell: Cell, source: str) -> str:
    """Return the name of a cell's log: by its config and the engine's source, or its version."""
    if (engine := cell.config.engine) is not None:
        source = f"{source} {installed_version(peer_of(engine.name).name)}"
    return hashlib.sha256(f"{cell.digest} {source}".encode()).hexdigest()[:16] + ".mcap"
