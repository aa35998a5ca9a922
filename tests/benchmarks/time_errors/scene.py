"""Scenes in a few words, each also with its world turned: bodies, configs, runs."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

sys.path.insert(0, str(Path(__file__).parents[2] / "physics"))
from shared_runs import GRAVITY, States, flow, plane, scenes_in_turn

__all__ = ["GRAVITY", "LEVEL", "TURNED", "UP", "World", "box", "cylinder", "flow", "leaning"]
__all__ += ["States", "matrix", "plane", "scenes_in_turn", "sphere"]
UP = np.array([0.0, 0.0, 1.0])


def sphere(radius: float) -> str:
    """Return the shape as a YAML mapping, as all of these."""
    return f"{{kind: sphere, radius: {radius!r}}}"


def box(*size: float) -> str:
    return f"{{kind: box, size: {flow(size)}}}"


def cylinder(radius: float, length: float, kind: str = "cylinder") -> str:
    return f"{{kind: {kind}, radius: {radius!r}, length: {length!r}}}"


def leaning(degrees: float, axis: str = "y") -> Rotation:
    return Rotation.from_euler(axis, degrees, degrees=True)


def matrix(quaternion: np.ndarray) -> np.ndarray:
    return Rotation.from_quat(quaternion, scalar_first=True).as_matrix()


class World:
    """A world that is turned as a whole: bodies are written as if it were level."""

    def __init__(self, turn: Rotation):
        self.turn = turn

    def level(self, vectors: np.ndarray) -> np.ndarray:
        """Return vectors of the turned world in the level one."""
        return np.asarray(vectors) @ self.turn.as_matrix()

    def vector(self, vector: Iterable[float]) -> str:
        return flow(self.turn.apply(np.array(list(vector), dtype=float)))

    def body(
        self,
        shape: str,
        place: Iterable[float],
        velocity: Iterable[float] = (0, 0, 0),
        spin: Iterable[float] = (0, 0, 0),
        turn: Rotation | None = None,
        *,
        mass: float = 1.0,
        held: str = "",
        surface: str = "one",
    ) -> str:
        """Return a body as a YAML mapping; held: `fixed` or `kinematic`, without a mass."""
        stands = self.turn * (turn or Rotation.identity())
        heavy = f"{held}: true" if held else f"mass: {mass!r}"
        moving = "" if held == "fixed" else f", velocity: {self.vector(velocity)}"
        if held != "fixed":
            moving += f", angular_velocity: {self.vector(spin)}"
        turned = flow(stands.as_quat(scalar_first=True))
        return (
            f"{{shape: {shape}, {heavy}, position: {self.vector(place)}, orientation: {turned}"
            f"{moving}, surface: {surface}}}"
        )

    def floor(self, surface: str = "one") -> str:
        normal = self.vector(UP)
        return f"{{shape: {{kind: plane, normal: {normal}}}, surface: {surface}}}"

    def config(
        self,
        bodies: Mapping[str, str],
        rate: int,
        seconds: float,
        surface: str = "friction: 1",
        gravity: Iterable[float] = (0, 0, -GRAVITY),
        surfaces: str = "",
    ) -> str:
        """Return a config; rate: steps a second, surface: of all that is `one`."""
        lines = "\n".join(f"    {name}: {body}" for name, body in bodies.items())
        steps = max(1, round(seconds * rate))
        return (
            f"scene:\n  gravity: {self.vector(gravity)}\n"
            f"  surfaces: {{one: {{{surface}}}{surfaces}}}\n  bodies:\n{lines}\n"
            f"numerics: {{timestep: 1/{rate}}}\nduration: {steps}/{rate}\n"
        )


LEVEL = World(Rotation.identity())
TURNED = World(Rotation.from_rotvec([0.4, -0.7, 0.5]))
