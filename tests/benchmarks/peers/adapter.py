"""The one interface to all engines: an adapter builds a scene into a handle that steps it.

Each `*_peer.py` has `VARIANTS` (name of an engine with one set of solver settings: what that set
is, in words), `version()` and `build(scene, variant) -> Handle`. Importing the module imports the
engine, so a missing one shows as ImportError.
"""

from __future__ import annotations

from importlib import import_module
from types import ModuleType
from typing import Final, Protocol

import numpy as np

from .description import Scene

# Engine: the module of its adapter. Variants are named engine or engine-something.
ADAPTERS: Final = {
    "lavender": "lavender_peer",
    "mujoco": "mujoco_peer",
    "bullet": "bullet_peer",
    "physx": "physx_peer",
    "rapier": "rapier_peer",
    "dart": "dart_peer",
}


class CannotRun(Exception):  # noqa: N818 - it is a fact about an engine, not a fault
    """This engine cannot simulate this scene as described; the message says what is missing."""


class Handle(Protocol):
    """One scene in one engine."""

    def step(self, count: int) -> None:
        """Advance by `count` timesteps; nothing else, this is what is timed."""

    def poses(self) -> np.ndarray:
        """Return x y z qw qx qy qz of the movable bodies, shape (bodies, 7) [m, -]."""

    def velocities(self) -> np.ndarray:
        """Return vx vy vz wx wy wz, world frame, shape (bodies, 6) [m/s, rad/s]."""

    def close(self) -> None:
        """Give back what the scene holds."""


class Engine:
    """One variant of an engine, ready to build scenes."""

    def __init__(self, variant: str) -> None:
        self.variant = variant
        self.module: ModuleType = import_module(
            f"{__package__}.{ADAPTERS[variant.partition('-')[0]]}"
        )
        if variant not in self.module.VARIANTS:
            known = ", ".join(self.module.VARIANTS)
            raise CannotRun(f"no variant {variant}; there are {known}")
        self.settings: str = self.module.VARIANTS[variant]
        self.version: str = self.module.version()

    def build(self, scene: Scene) -> Handle:
        """Return the scene at its initial state; raises CannotRun."""
        handle: Handle = self.module.build(scene, self.variant)
        return handle


def variants_of(asked: list[str]) -> tuple[list[Engine], dict[str, str]]:
    """Return the engines of the names asked for, and why others are missing.

    A bare engine name stands for all its variants; `engine-variant` for one; `engine-default` for
    the one with the engine's own settings.
    """
    found: list[Engine] = []
    missing: dict[str, str] = {}
    for name in asked:
        engine, _, variant = name.partition("-")
        try:
            if engine not in ADAPTERS:
                raise CannotRun(f"no adapter; there are {', '.join(ADAPTERS)}")
            module = import_module(f"{__package__}.{ADAPTERS[engine]}")
            if not variant:
                names = list(module.VARIANTS)
            else:
                names = [engine if variant == "default" else name]
            found += [Engine(each) for each in names]
        except (ImportError, OSError, CannotRun) as error:
            missing[name] = str(error).splitlines()[0]
    return found, missing
