"""The settings of other engines in a cost grid: timesteps x what each engine declares as swept.

An engine's own defaults are among them, tuned variants beside them. A setting is a product of the
sweep, with the experiment's own axes inside it:

    - {preset: .., engine: mujoco-stiff, timestep: .., mujoco_iterations: .., <own axes>}
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import product
from typing import Any

from lavendersim.peers.catalogue import LAVENDER, PEERS, peer_of
from lavendersim.peers.declaration import Value

Own = tuple[tuple[str, Value], ...]  # settings of an engine that a grid varies, by name


def variants_of(engine: str, timesteps: Sequence[Fraction]) -> Iterator[tuple[str, Own, Fraction]]:
    """Yield variant, settings, timestep of each setting of an engine; or of one variant of it."""
    whole = engine in PEERS
    own = [one for one in peer_of(engine).swept if whole or one.variant == engine]
    swept = [(one.variant, one.values) for one in own] or [(engine, {})]
    for variant, values in swept:
        for chosen in product(*values.values()):
            for timestep in timesteps:
                yield variant, tuple(zip(values, chosen, strict=True)), timestep


def paths_of(engine: str, own: Own) -> dict[str, tuple[str, Value]]:
    """Return path and value by axis of what a setting has of another engine; nothing of ours."""
    if engine == LAVENDER:
        return {}
    name = peer_of(engine).name
    settings = {f"{name}_{key}": (f"engines.{name}.{key}", value) for key, value in own}
    return {"engine": ("engine", engine), **settings}


def section_of(engine: str, own: Own) -> dict[str, Any]:
    """Return the keys of a config that choose an engine with these settings."""
    settings = {"engines": {peer_of(engine).name: dict(own)}} if own else {}
    return {"engine": engine, **settings}
