"""The engines by the names that a config has, and which of them are installed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from importlib import import_module
from typing import Final

from lavendersim.errors import UsageError
from lavendersim.peers.declaration import Peer
from lavendersim.quantities.found import nearest, quoted

LAVENDER: Final = "lavender"
ALL: Final = "all"
MODULES: Final = ("mujoco", "rapier", "bullet", "physx", "dart", "drake")  # in the order of `all`

PEERS: Final[dict[str, Peer]] = {
    name: import_module(f"lavendersim.peers.{name}").PEER for name in MODULES
}
# What a config has without other keys.
OUR_LAW: Final = "rigid contacts, Coulomb's cone, Newton's law of restitution"
OURS: Final = ("sweeps of a step's solves", "grows with the contacts")
# Every name that `engine` may have.
NAMES: Final = (LAVENDER, *(variant for peer in PEERS.values() for variant in peer.variants))


def peer_of(engine: str) -> Peer:
    """Return the engine of a variant, such as `mujoco-stiff`."""
    return PEERS[engine.partition("-")[0]]


@cache
def installed_version(name: str) -> str:
    """Return the version of an engine, empty where it is not installed; nothing is imported."""
    from importlib.metadata import PackageNotFoundError, version  # late: it takes milliseconds

    try:
        return version(PEERS[name].package)
    except PackageNotFoundError:
        return ""


def installed() -> tuple[str, ...]:
    """Return the names of the engines that can run here, lavender first."""
    return (LAVENDER, *(name for name in PEERS if installed_version(name)))


def unknown(engine: str) -> str:
    """Return why a name is none of an engine, with the nearest, and what is installed."""
    here = f"installed here: {', '.join(installed())}"
    return f"no engine is called {quoted(engine)} ({here}){nearest(engine, NAMES)}"


def chosen(names: Sequence[str]) -> tuple[str, ...]:
    """Return the engines that are meant, each once; `all` is every one that is installed.

    names: with commas between, or several. UsageError for one that is unknown or not installed.
    """
    found: dict[str, None] = {}
    for name in (part.strip() for text in names for part in text.split(",")):
        if name != ALL and name not in NAMES:
            raise UsageError(unknown(name))
        if name != ALL and (why := missing(name)):
            raise UsageError(why)
        found.update(dict.fromkeys(installed() if name == ALL else [name]))
    return tuple(found)


def overrides_of(engines: Sequence[str]) -> list[str]:
    """Return the options that have these engines simulate a config: one, or an axis of several."""
    if len(engines) == 1:
        return [f"set engine={engines[0]}"]
    return [f"sweep engine=engine:[{', '.join(engines)}]"] if engines else []


def effort_of(engine: str) -> str:
    """Return what the iterations of an engine are, and for how many contacts it has room."""
    iterations, capacity = OURS
    if engine != LAVENDER:
        peer = peer_of(engine)
        iterations, capacity = peer.iterations, peer.capacity
    return f"iterations: {iterations}; room for contacts: {capacity}"


def facts_of(engine: str) -> dict[str, str]:
    """Return what an engine solves, how precisely and what it reports, by term."""
    if engine == LAVENDER:
        iterations, capacity = OURS
        return {
            "engine": engine,
            "law": OUR_LAW,
            "precision": "double",
            "reports": "everything",
            "iterations": iterations,
            "capacity": capacity,
            "repeats": "the same bits",
        }
    peer = peer_of(engine)
    reported = [one for one in peer.reports(engine) if one not in "xyz"]
    return {
        "engine": engine,
        "version": installed_version(peer.name) or f"not installed: pip install {peer.package}",
        "variant": peer.variants[engine].doc,
        "law": peer.law,
        "precision": "double" if peer.double else "single",
        "reports": ", ".join(reported) or "nothing of contacts",
        "iterations": peer.iterations,
        "capacity": peer.capacity,
        "repeats": peer.repeats,
    }


def untried(engines: Iterable[str]) -> list[str]:
    """Return a sentence for each engine whose installed version no test has run, each once."""
    peers = {peer_of(engine).name: peer_of(engine) for engine in engines if engine != LAVENDER}
    return [
        f"{peer.title} of {peer.package} {version} was never tried with lavender; tests have run "
        f"{', '.join(peer.tried)}"
        for name, peer in peers.items()
        if (version := installed_version(name)) and version not in peer.tried
    ]


def missing(engine: str) -> str:
    """Return how to install the engine of a variant; empty where it is."""
    if engine == LAVENDER or installed_version(peer_of(engine).name):
        return ""
    peer = peer_of(engine)
    return (
        f"{peer.title} is not installed: `pip install {peer.package}` (all engines: `pip install "
        f"lavendersim[engines]`); installed here: {', '.join(installed())}"
    )
