"""Scenes on lavender: a config is written, checked, planned and built; its engine is stepped."""

from __future__ import annotations

import json
from typing import Any, Final

import numpy as np

import lavendersim
from lavendersim.engine.records import RUNNING
from lavendersim.errors import LavenderError
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import build as build_arrays
from lavendersim.scene.plan import plan_of

from .adapter import CannotRun
from .description import Body, Box, Scene, Sphere

VARIANTS: Final = {"lavender": "the default numerics, only the timestep given"}


def version() -> str:
    """Return the package's version."""
    return f"lavender {lavendersim.__version__}"


def _shape(body: Body) -> dict[str, Any]:
    shape = body.shape
    if isinstance(shape, Sphere):
        return {"kind": "sphere", "radius": shape.radius}
    if isinstance(shape, Box):
        return {"kind": "box", "size": list(shape.size)}
    return {"kind": "plane", "normal": list(shape.normal), "offset": shape.offset}


def _surface(scene: Scene) -> dict[str, float]:
    return {"restitution": scene.restitution, "friction": scene.friction}


def _body(body: Body) -> dict[str, Any]:
    written: dict[str, Any] = {"shape": _shape(body), "surface": "all"}
    if written["shape"]["kind"] == "plane":
        return written
    written |= {"position": list(body.position), "orientation": list(body.orientation)}
    if not body.moves:
        return written | {"fixed": True}
    written |= {
        "mass": body.mass,
        "velocity": list(body.velocity),
        "angular_velocity": list(body.angular_velocity),
    }
    if body.principal is not None:
        written["inertia"] = list(body.principal)
    return written


def config(scene: Scene) -> dict[str, Any]:
    """Return the scene as an experiment of lavender."""
    return {
        "scene": {
            "gravity": list(scene.gravity),
            "surfaces": {"all": _surface(scene)},
            "bodies": {f"body_{k}": _body(body) for k, body in enumerate(scene.bodies)},
        },
        "numerics": {"timestep": str(scene.timestep)},
        "duration": float(scene.steps * scene.timestep),
    }


def text(scene: Scene) -> str:
    """Return the experiment as text; JSON is YAML, but for ratios, which stand without quotes."""
    ratio = str(scene.timestep)
    return json.dumps(config(scene)).replace(f'"timestep": "{ratio}"', f'"timestep": {ratio}')


class LavenderHandle:
    """One engine; nothing is recorded."""

    def __init__(self, scene: Scene) -> None:
        try:
            (cell,) = load_experiment_text(text(scene), "peers.yaml").cells()
            plan = plan_of(cell.config, record=False)
        except LavenderError as error:
            raise CannotRun(f"refuses the scene: {str(error).splitlines()[0][:160]}") from error
        self.engine = build_arrays(cell.config, plan.spec).engine(plan.spec)
        self.rows = [k for k, body in enumerate(scene.bodies) if body.moves]
        self.engine.advance(0)  # compiles or loads the kernel

    def step(self, count: int) -> None:
        """Advance by `count` timesteps."""
        if self.engine.advance(count) != RUNNING:
            raise CannotRun(f"diverged at step {int(self.engine.counters['step'][0])}")

    def poses(self) -> np.ndarray:
        """Return poses, shape (bodies, 7)."""
        found = _columns(self.engine.bodies, ("x", "y", "z", "qw", "qx", "qy", "qz"))
        if "qw" not in (self.engine.bodies.dtype.names or ()):
            found[:, 3] = 1.0
        return found[self.rows]

    def velocities(self) -> np.ndarray:
        """Return velocities, shape (bodies, 6)."""
        return _columns(self.engine.velocities, ("vx", "vy", "vz", "wx", "wy", "wz"))[self.rows]

    def close(self) -> None:
        """Drop the engine."""
        del self.engine


def _columns(records: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    """Return fields as columns; a field that the scene does not require is 0."""
    held = records.dtype.names or ()
    zero = np.zeros(len(records))
    return np.column_stack([records[name] if name in held else zero for name in names])


def build(scene: Scene, variant: str) -> LavenderHandle:
    """Return the scene at its initial state; raises CannotRun where the config is refused."""
    assert variant in VARIANTS
    return LavenderHandle(scene)
