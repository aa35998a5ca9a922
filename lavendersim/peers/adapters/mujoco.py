"""Scenes on MuJoCo."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from typing import Any, Final

import mujoco
import numpy as np

from lavendersim.peers.declaration import Value
from lavendersim.peers.description import PeerBody, Scene
from lavendersim.peers.restitution_spring import restitutions, spring_of
from lavendersim.peers.world import Floats

KEYS: Final = ("friction", "restitution")
OPTIONS: Final = ("solver", "iterations", "tolerance", "cone", "integrator", "impratio")


def _text(values: Any) -> str:
    return " ".join(f"{value:.17g}" for value in values)


class World:
    """A model and its data."""

    def __init__(self, scene: Scene, settings: Mapping[str, Value]) -> None:
        self._of, self._dt = settings, scene.timestep
        self.model = mujoco.MjModel.from_xml_string(self._xml(scene))
        self.data = mujoco.MjData(self.model)
        self._rows = [int(self.model.geom(k).name.split("_")[1]) for k in range(self.model.ngeom)]
        for k, body in enumerate(scene.movable):  # a free joint's spin is in the body's frame
            turn, inverse = np.zeros(3), np.array(body.orientation) * (1.0, -1.0, -1.0, -1.0)
            mujoco.mju_rotVecQuat(turn, np.array(body.spin), inverse)
            self.data.qvel[6 * k : 6 * k + 6] = [*body.velocity, *turn]

    def _contact(self, friction: float, restitution: float) -> str:
        """Return solref, solimp, margin and condim of a contact."""
        get, dt, margin = self._of.get, self._dt, self._of.get("margin", 0.0)
        soft = dt * float(get("time_constant_steps", 0.0)) or get("time_constant", 0.02)
        reference, share = (soft, get("damping_ratio", 1.0)), get("impedance")
        if restitution > 0.0:  # (-stiffness, -damping): a free half swing keeps e of the speed
            reference, share = spring_of(restitution, dt), share or 0.9999
        rest = f'solref="{_text(reference)}" margin="{margin}" condim="{3 if friction else 1}"'
        return rest + (f' solimp="{share} {share} 0.001"' if share else "")

    def _geom(self, name: str, shape: Any, place: str, rest: str, meshes: list[str]) -> str:
        if shape.kind == "plane":
            place = f'pos="{_text(shape.offset * n for n in shape.normal)}"'
            form = f'type="plane" size="0 0 1" zaxis="{_text(shape.normal)}"'
        elif shape.kind == "hull":
            corners = _text(number for point in shape.points for number in point)
            meshes.append(f'<mesh name="{name}" vertex="{corners}" inertia="convex"/>')
            form = f'type="mesh" mesh="{name}"'
        else:
            edges = shape.size if hasattr(shape, "size") else (2.0 * shape.radius,)
            edges += (shape.length,) if shape.kind in ("capsule", "cylinder") else ()
            form = f'type="{shape.kind}" size="{_text(0.5 * edge for edge in edges)}"'
        return f'<geom name="{name}" {form} {place} {rest}/>'

    def _xml(self, scene: Scene) -> str:
        shared, bodies, pairs, meshes = scene.by_first(KEYS), [""], [""], [""]
        for body in scene.bodies:
            rest = 'contype="0" conaffinity="0"'
            if shared is not None:  # who comes first has the values of its contacts
                first, (mu, e) = int(shared[1] and not body.moves), shared[0][body.row]
                rest = f'priority="{first}" friction="{mu:.17g} 0 0" {self._contact(mu, e)}'
            geoms = "".join(self._geom(*part, rest, meshes) for part in _parts(body))
            place = f'pos="{_text(body.position)}" quat="{_text(body.orientation)}"'
            inertial = f'<inertial pos="0 0 0" mass="{body.mass:.17g}" diaginertia='
            free = f'<freejoint/>{inertial}"{_text(body.inertia)}"/>' if body.moves else ""
            whole = f"<body {place}>{free}{geoms}</body>"
            bodies.append(geoms if body.shape.kind == "plane" else whole)
        for a, b in scene.pairs() if shared is None else ():
            mu, e = (scene.of_pair(key, a, b) for key in KEYS)
            rest = f'friction="{_text((mu, mu, 0, 0, 0))}" {self._contact(mu, e)}'
            for (one, *_), (other, *_) in product(_parts(a), _parts(b)):
                pairs.append(f'<pair geom1="{one}" geom2="{other}" {rest}/>')
        options = " ".join(f'{key}="{self._of[key]}"' for key in OPTIONS if key in self._of)
        return f"""<mujoco><compiler autolimits="false" boundmass="0" boundinertia="0"/>
  <option timestep="{self._dt:.17g}" gravity="{_text(scene.gravity)}" {options}>
  <flag autoreset="disable" {'speculative="enable"' * bool(self._of.get("speculative"))}/></option>
  <size memory="{self._of.get("memory", 512)}M"/><asset>{"".join(meshes)}</asset>
  <worldbody>{"".join(bodies)}</worldbody><contact>{"".join(pairs)}</contact></mujoco>"""

    def inertias(self) -> Floats:
        """Return mass and principal moments."""
        moving = self.model.body_dofnum > 0
        return np.column_stack([self.model.body_mass[moving], self.model.body_inertia[moving]])

    def mixed(self) -> tuple[Floats, Floats]:
        """Return friction and restitution of every two bodies: by priority, else the larger."""
        model, rows = self.model, self._rows
        geoms = [rows.index(row) for row in range(max(rows) + 1)]
        first = model.geom_priority[geoms]
        own = np.array([model.geom_friction[geoms, 0], restitutions(model.geom_solref[geoms])])
        one, other = own[:, :, None], own[:, None]
        found = np.choose(1 + np.sign(first[:, None] - first), (other, np.maximum(one, other), one))
        of_pairs = np.array([model.pair_friction[:, 0], restitutions(model.pair_solref)])
        for k, (a, b) in enumerate(zip(model.pair_geom1, model.pair_geom2, strict=True)):
            found[:, [rows[a], rows[b]], [rows[b], rows[a]]] = of_pairs[:, k, None]
        return found[0], found[1]

    def poses(self) -> Floats:
        """Return poses."""
        return np.array(self.data.qpos).reshape(-1, 7)

    def velocities(self) -> Floats:
        """Return velocities."""
        found: Floats = np.array(self.data.qvel).reshape(-1, 6)
        for row, pose in zip(found, self.poses(), strict=True):
            mujoco.mju_rotVecQuat(row[3:], row[3:].copy(), pose[3:])
        return found

    def push(self, loads: Floats) -> None:
        """Have forces and torques act in the next step."""
        self.data.xfrc_applied[self.model.body_dofnum > 0] = loads

    def step(self) -> None:
        """Advance by one timestep."""
        mujoco.mj_step(self.model, self.data)

    def iterations(self) -> int:
        """Return those of the last step."""
        return int(np.max(self.data.solver_niter))

    def is_full(self) -> bool:
        """Return whether contacts, or their constraints, of any step yet had no room."""
        full = mujoco.mjtWarning.mjWARN_CONTACTFULL, mujoco.mjtWarning.mjWARN_CNSTRFULL
        return any(self.data.warning[one].number for one in full)

    def contacts(self) -> list[tuple[float, ...]]:
        """Return the contacts of the last step; RK4 leaves those of its last stage."""
        seen, force, rows = [], np.zeros(6), self._rows
        for k, one in enumerate(self.data.contact):
            mujoco.mj_contactForce(self.model, self.data, k, force)
            (n, t1, t2), push = one.frame.reshape(3, 3), force[:3] * self._dt
            slide = (*(push[1] * t1 + push[2] * t2), one.friction[0] if one.dim > 1 else 0.0)
            seen.append((rows[one.geom1], rows[one.geom2], *one.pos, *n, one.dist, push[0], *slide))
        return seen


def _parts(body: PeerBody) -> list[tuple[str, Any, str]]:
    """Return name, shape and place of each piece of a body."""
    return [
        (f"g_{body.row}_{k}", shape, f'pos="{_text(position)}" quat="{_text(turn)}"')
        for k, (shape, position, turn) in enumerate(body.pieces())
    ]
