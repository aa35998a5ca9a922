"""Scenes on MuJoCo. Contacts are spring-dampers in a convex problem; Newton's method solves it."""

from __future__ import annotations

from math import log, pi, sqrt
from typing import Final

import mujoco
import numpy as np

from .description import Body, Box, Plane, Scene, Sphere

VARIANTS: Final = {
    "mujoco": "default solref 0.02 1, solimp 0.9 0.95, pyramidal cone, Euler",
    "mujoco-stiff": "solref 2dt 1, solimp 0.9999, margin 1 um, elliptic cone, Euler",
    "mujoco-cg": "as stiff, conjugate gradients instead of Newton's method",
    "mujoco-rk4": "as stiff, Runge-Kutta of order 4",
    "mujoco-discrete": "discrete integrator, solref dt/4 1, solimp 0.999 0.9999, margin 1 um, "
    "elliptic cone, speculative contacts",
}
# MuJoCo has no coefficient of restitution: e is given by an underdamped contact spring that swings
# for this many steps. Shorter swings are resolved worse by its integrators.
SWING_STEPS: Final = 12
# Bodies that start touching are apart by round-off. Where that is a contact too many or too few in
# the first step, a stiff tower of 100 is kicked and falls; this margin is more than round-off [m].
ROUNDING: Final = 1e-6


def version() -> str:
    """Return the engine's version."""
    return f"MuJoCo {mujoco.__version__}"


def _numbers(values: tuple[float, ...]) -> str:
    return " ".join(f"{value:.17g}" for value in values)


def solref(scene: Scene, stiffest: float) -> tuple[float, float]:
    """Return the reference of the contact spring.

    Without restitution (time constant `stiffest` [s], damping ratio 1); with it the direct form
    (-stiffness, -damping) [1/s^2, 1/s] of a spring whose free half swing keeps e of the speed:
    e = exp(-pi zeta / sqrt(1 - zeta^2)).
    """
    if scene.restitution == 0.0:
        return stiffest, 1.0
    decay = -log(scene.restitution) / pi  # zeta / sqrt(1 - zeta^2)
    zeta = decay / sqrt(1.0 + decay * decay)
    swing = SWING_STEPS * float(scene.timestep)
    natural = pi / (swing * sqrt(1.0 - zeta * zeta))
    return -natural * natural, -2.0 * zeta * natural


def _geometry(body: Body) -> str:
    shape = body.shape
    if isinstance(shape, Sphere):
        return f'type="sphere" size="{shape.radius:.17g}"'
    if isinstance(shape, Box):
        return f'type="box" size="{_numbers(tuple(0.5 * edge for edge in shape.size))}"'
    point = tuple(shape.offset * n for n in shape.normal)
    return f'type="plane" size="0 0 1" pos="{_numbers(point)}" zaxis="{_numbers(shape.normal)}"'


def _element(body: Body) -> str:
    if isinstance(body.shape, Plane):
        return f"<geom {_geometry(body)}/>"
    place = f'pos="{_numbers(body.position)}" quat="{_numbers(body.orientation)}"'
    if not body.moves:
        return f"<body {place}><geom {_geometry(body)}/></body>"
    inertial = (
        f'<inertial pos="0 0 0" mass="{body.mass:.17g}" diaginertia="{_numbers(body.inertia)}"/>'
    )
    return f"<body {place}><freejoint/>{inertial}<geom {_geometry(body)}/></body>"


def xml(scene: Scene, variant: str) -> str:
    """Return the model as MuJoCo reads it."""
    dt = float(scene.timestep)
    option, flags, margin = "", "", 0.0
    time_constant, impedance = 0.02, "0.9 0.95 0.001"
    if variant != "mujoco":
        option, margin = 'cone="elliptic" tolerance="1e-10"', ROUNDING
        time_constant, impedance = 2.0 * dt, "0.9999 0.9999 0.001"
    if variant == "mujoco-cg":
        option += ' solver="CG"'
    if variant == "mujoco-rk4":
        option += ' integrator="RK4"'
    if variant == "mujoco-discrete":
        option += ' integrator="discrete"'
        time_constant, impedance = 0.25 * dt, "0.999 0.9999 0.001"
        flags = '<flag speculative="enable"/>'
    if scene.restitution:
        impedance = "0.9999 0.9999 0.001"
    reference = _numbers(solref(scene, time_constant))
    return f"""
<mujoco>
  <compiler autolimits="false" boundmass="0" boundinertia="0"/>
  <option timestep="{dt:.17g}" gravity="{_numbers(scene.gravity)}" {option}>{flags}</option>
  <size memory="512M"/>
  <default>
    <geom friction="{scene.friction:.17g} 0 0" condim="{3 if scene.friction else 1}"
      solref="{reference}" solimp="{impedance}" margin="{margin:.17g}"/>
  </default>
  <worldbody>{"".join(_element(body) for body in scene.bodies)}</worldbody>
</mujoco>"""


class MujocoHandle:
    """A model and its data."""

    def __init__(self, scene: Scene, variant: str) -> None:
        self.model = mujoco.MjModel.from_xml_string(xml(scene, variant))
        self.data = mujoco.MjData(self.model)
        for k, body in enumerate(scene.movable):
            turn = np.zeros(3)
            inverse = np.array(body.orientation) * (1.0, -1.0, -1.0, -1.0)
            mujoco.mju_rotVecQuat(turn, np.array(body.angular_velocity), inverse)
            # A free joint's angular velocity is in the body's frame.
            self.data.qvel[6 * k : 6 * k + 6] = [*body.velocity, *turn]

    def step(self, count: int) -> None:
        """Advance by `count` timesteps."""
        mujoco.mj_step(self.model, self.data, count)

    def poses(self) -> np.ndarray:
        """Return poses, shape (bodies, 7)."""
        return self.data.qpos.reshape(-1, 7).copy()

    def velocities(self) -> np.ndarray:
        """Return velocities, shape (bodies, 6)."""
        found = self.data.qvel.reshape(-1, 6).copy()
        for row, pose in zip(found, self.poses(), strict=True):
            mujoco.mju_rotVecQuat(row[3:], row[3:].copy(), pose[3:])
        return found

    def close(self) -> None:
        """Drop the model."""
        del self.model, self.data


def build(scene: Scene, variant: str) -> MujocoHandle:
    """Return the scene at its initial state."""
    return MujocoHandle(scene, variant)
