"""A drawn scene as others see it: turned, shifted, in a mirror, listed otherwise, in other units.

A view maps a cell's config to another one, and poses of its run to those that the other's must
have. Of a resolved cell, whose bodies stand in their principal frames: what is of a body's frame
changes in a mirror alone. Powers of two as units round nothing as they are written.
"""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.geometry.rotations import rotation_matrix

Tree = dict[str, Any]
# Units of keys, as powers of length and time. Of functions of time `offset` has none; what joints
# and triggers have is brought into the view where they stand.
UNITS = {
    "duration": (0, 1), "at": (0, 1), "from": (0, 1), "to": (0, 1), "times": (0, 1),
    "timestep": (0, 1), "smallest_timestep": (0, 1), "sleep_time": (0, 1),
    "frequency": (0, -1), "rate": (0, -1), "damping": (0, -1), "linear": (0, -1),
    "stiffness": (0, -2), "compliance": (0, 2), "quadratic": (-1, 0), "angular": (2, -1),
    "radius": (1, 0), "length": (1, 0), "size": (1, 0), "semi_axes": (1, 0), "points": (1, 0),
    "height": (1, 0), "vertices": (1, 0), "heights": (1, 0), "spacing": (1, 0),
    "position": (1, 0), "offset": (1, 0), "centre": (1, 0), "inertia": (2, 0),
    "rest_length": (1, 0), "point_a": (1, 0), "point_b": (1, 0), "point": (1, 0), "through": (1, 0),
    "displacement": (1, 0), "teleport": (1, 0), "slop": (1, 0), "cache_distance": (1, 0),
    "torsional_friction": (1, 0), "rolling_friction": (1, 0),
    "velocity": (1, -1), "surface_velocity": (1, -1), "stribeck_velocity": (1, -1),
    "yield_speed": (1, -1), "sleep_speed": (1, -1), "tolerance": (1, -1),
    "angular_velocity": (0, -1), "gravity": (1, -2), "force": (1, -2), "torque": (2, -2),
    "cohesion": (1, -2), "max_force": (1, -2), "max_torque": (2, -2),
}  # fmt: skip
POINTS = ("position", "teleport", "through")  # of the world
POLAR = ("velocity", "gravity", "displacement", "along")  # of the world
AXIAL = ("angular_velocity", "turn")  # of the world
OF_BODY = ("point_a", "point_b", "surface_velocity", "grain", "point", "centre")
MIRROR = np.array([-1.0, 1.0, 1.0])  # across x
WITH_UNITS = ("scene", "events", "triggered", "numerics", "duration")


class View(NamedTuple):
    """How a scene is seen: in a mirror, then turned, then shifted, then in other units."""

    name: str
    mirror: bool = False
    turn: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)  # unit quaternion
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [m]
    length: float = 1.0
    time: float = 1.0
    order: int | None = None  # seed of another order of the list of bodies

    @property
    def flip(self) -> np.ndarray:
        """What a mirror makes of the parts of a vector of a body's frame."""
        return MIRROR if self.mirror else np.ones(3)

    @property
    def hand(self) -> float:
        """What a mirror makes of a turn's sense, beside."""
        return -1.0 if self.mirror else 1.0

    def polar(self, vector: Any) -> Any:
        """Return a vector of the world as it is seen, without units; or many."""
        return (np.asarray(vector) * self.flip) @ rotation_matrix(self.turn).T

    def axial(self, vector: Any) -> Any:
        """Return an axis of turning as it is seen."""
        return self.hand * self.polar(vector)

    def orientation(self, quaternion: Any) -> Any:
        """Return orientations as they are seen, of frames that are seen in the mirror, too."""
        q = np.asarray(quaternion, float)
        axis = self.hand * self.flip * q[..., 1:]
        w, turn = self.turn[0], np.array(self.turn[1:])
        part = w * axis + q[..., :1] * turn + np.cross(turn, axis)
        return np.concatenate([w * q[..., :1] - (axis @ turn)[..., None], part], axis=-1)

    def poses(self, plain: np.ndarray, planes: list[bool]) -> np.ndarray:
        """Return poses with velocities (steps, bodies, 13), of the plain run, as they are seen.

        planes: which bodies are; they stand in the origin of every view.
        """
        seen = plain.copy()
        seen[..., :3] = self.length * (self.polar(plain[..., :3]) + np.array(self.shift))
        seen[..., 3:7] = self.orientation(plain[..., 3:7])
        seen[..., 7:10] = self.length / self.time * self.polar(plain[..., 7:10])
        seen[..., 10:] = self.axial(plain[..., 10:]) / self.time
        seen[:, planes] = plain[:, planes]
        return seen

    def plain_poses(self, seen: np.ndarray, planes: list[bool]) -> np.ndarray:
        """Return poses of the run in other units, in those of the plain one; see `poses`."""
        plain = seen.copy()
        plain[..., :3] /= self.length
        plain[..., 7:10] /= self.length / self.time
        plain[..., 10:] *= self.time
        plain[:, planes] = seen[:, planes]
        return plain

    def names(self, bodies: Any) -> list[str]:
        """Return the names of bodies in the order of the view."""
        listed = [*bodies]
        if self.order is not None:
            random.Random(self.order).shuffle(listed)
        return listed

    def config(self, cell: CellConfig) -> CellConfig:
        """Return the cell as it is seen."""
        tree: Tree = cell.as_dict()
        scene = tree["scene"]
        for body in scene["bodies"].values():
            self._body(body)
        for force in scene["forces"]:
            self._force(force)
        scene["gravity"] = self.polar(scene["gravity"]).tolist()
        planes = {name for name, body in scene["bodies"].items()
                  if body["shape"]["kind"] == "plane"}  # fmt: skip
        for one in scene.get("springs", ()):
            for end in ("a", "b"):
                one[f"point_{end}"] = self._end(one[f"point_{end}"], one[end] in planes)
        for one in scene.get("connections", {}).values():
            self._connection(one, planes)
        for event in (*tree["events"], *(one["event"] for one in tree.get("triggered", ()))):
            self._moves(event)
        for one in tree.get("triggered", ()):
            self._trigger(one["when"])
        if (self.length, self.time) != (1.0, 1.0):
            of_cell = {key: value for key, value in tree.items() if key in WITH_UNITS}
            tree |= self._in_units(of_cell)
            scene = tree["scene"]
        tree["scene"]["bodies"] = {
            name: tree["scene"]["bodies"][name] for name in self.names(scene["bodies"])
        }
        return CellConfig.from_dict(tree)

    def _moves(self, owner: Tree) -> None:
        """Bring the vectors of the world that something has into the view."""
        for names, seen in ((POINTS, self._point), (POLAR, self.polar), (AXIAL, self.axial),
                            (("orientation",), self.orientation)):  # fmt: skip
            for name in names:
                if owner.get(name) is not None:
                    owner[name] = seen(owner[name]).tolist()

    def _point(self, point: Any) -> Any:
        return self.polar(point) + np.array(self.shift)

    def _end(self, point: Any, of_plane: bool) -> list[float]:
        """A point of a body's frame; that of a plane is the world's."""
        seen = self._point(point) if of_plane else self.flip * np.asarray(point)
        return [float(x) for x in seen]

    def _body(self, body: Tree) -> None:
        shape = body["shape"]
        if shape["kind"] == "plane":
            for name in ("surface_velocity", "grain"):
                if body.get(name):
                    body[name] = self.polar(body[name]).tolist()
            normal = self.polar(shape["normal"])
            size = float(np.linalg.norm(normal))
            shape["offset"] += float(normal @ np.array(self.shift)) / size
            shape["normal"] = normal.tolist()
            return
        self._moves(body)
        for motion in body.get("motion", ()):
            self._moves(motion)
        for name in ("surface_velocity", "grain"):
            if body.get(name):
                body[name] = (self.flip * np.array(body[name])).tolist()
        if self.mirror:
            self._shape(shape)

    def _shape(self, shape: Tree) -> None:
        if shape["kind"] == "hull":
            shape["points"] = (self.flip * np.array(shape["points"])).tolist()
            shape["faces"] = [[*reversed(face)] for face in shape["faces"]]
        if shape["kind"] == "mesh":
            shape["vertices"] = (self.flip * np.array(shape["vertices"])).tolist()
            shape["triangles"] = [[*reversed(corners)] for corners in shape["triangles"]]
        for part in shape.get("parts", ()):
            part["position"] = (self.flip * np.array(part["position"])).tolist()
            turn = self.hand * self.flip * np.array(part["orientation"][1:])
            part["orientation"] = [part["orientation"][0], *turn.tolist()]
            self._shape(part["shape"])

    def _force(self, force: Tree) -> None:
        force["point"] = (self.flip * np.array(force["point"])).tolist() if "point" in force else [
            0.0, 0.0, 0.0]  # fmt: skip
        if force.get("frame") == "body":
            force["force"] = (self.flip * np.array(force["force"])).tolist()
            force["torque"] = (self.hand * self.flip * np.array(force["torque"])).tolist()
        else:
            force["force"] = self.polar(force["force"]).tolist()
            force["torque"] = self.axial(force["torque"]).tolist()

    def _connection(self, one: Tree, planes: set[str]) -> None:
        if one["kind"] == "rope":
            pairs = zip(one["points"], one["between"], strict=True)
            one["points"] = [self._end(point, name in planes) for point, name in pairs]
            return
        one["at"] = (self.length * self._point(one["at"])).tolist()  # elsewhere a time
        if one.get("axis") is not None:
            along = self.axial if one["kind"] == "hinge" else self.polar
            one["axis"] = along(one["axis"]).tolist()
        slides = one["kind"] == "slider"
        if one.get("limits") and slides:
            one["limits"] = [self.length * x for x in one["limits"]]
        if one.get("motor"):
            one["motor"]["speed"] *= (self.length if slides else 1.0) / self.time

    def _trigger(self, when: Tree) -> None:
        if when["along"] is not None:
            along = self.polar(when["along"])
            when["value"] += float(along @ np.array(self.shift))
            when["along"] = along.tolist()
            when["value"] *= self.length
        elif when["value"] is not None:
            when["value"] *= self.length / self.time

    def _in_units(self, value: Any, key: str = "") -> Any:
        if isinstance(value, dict):
            joint = value.get("kind") in ("ball", "hinge", "slider", "fixed")
            function = "kind" in value and "frequency" in value
            return {
                name: one if (joint and name == "at") or (function and name == "offset")
                else self._in_units(one, name)
                for name, one in value.items()
            }  # fmt: skip
        if isinstance(value, list):
            return [self._in_units(one, key) for one in value]
        if key not in UNITS or value is None:
            return value
        length, time = UNITS[key]
        if isinstance(value, str):  # a ratio
            return str(Fraction(value) * Fraction(self.time) ** time)
        return value * self.length**length * self.time**time


def _reach(shape: Tree) -> float:
    """Return how far a shape reaches from its centre, or somewhat less [m]."""
    if shape["kind"] == "compound":
        return max(_reach(part["shape"]) for part in shape["parts"])
    if shape["kind"] == "hull":
        return float(np.linalg.norm(shape["points"], axis=1).max())
    if shape["kind"] == "box":
        return 0.5 * float(np.linalg.norm(shape["size"]))
    if shape["kind"] == "ellipsoid":
        return float(max(shape["semi_axes"]))
    if shape["kind"] == "cone":
        return float(max(0.75 * shape["height"], shape["radius"]))
    if shape["kind"] == "mesh":
        return float(np.linalg.norm(shape["vertices"], axis=1).max())
    return float(shape["radius"] + 0.5 * shape.get("length", 0.0))


def nudged(cell: CellConfig, size: float, seed: int, arms: bool = False) -> CellConfig:
    """Return a cell whose bodies stand, turn and fly by a share of `size` otherwise.

    arms: they turn by as much as moves their ends by that share of where they stand. A contact acts
    at a place of the world, whose last digit is many of a small body's arm.
    """
    draw, tree = random.Random(seed), cell.as_dict()
    bodies = [b for b in tree["scene"]["bodies"].values() if b["shape"]["kind"] != "plane"]
    far = max(float(np.abs(body["position"]).max()) for body in bodies)
    for body in bodies:
        turn = max(far / _reach(body["shape"]), 1.0) if arms else 1.0
        for name, least in (("position", far), ("orientation", turn), ("velocity", 0.0),
                            ("angular_velocity", 0.0)):  # fmt: skip
            if name in body and body[name] is not None:
                body[name] = [x + size * draw.uniform(-1.0, 1.0) * max(abs(x), least)
                              for x in body[name]]  # fmt: skip
        if body.get("orientation") is not None:  # of a resolved cell it is a unit quaternion
            q = np.array(body["orientation"])
            body["orientation"] = (q / np.linalg.norm(q)).tolist()
    for body in tree["scene"]["bodies"].values():
        if body["shape"]["kind"] == "plane":
            body["shape"]["offset"] += size * draw.uniform(-1.0, 1.0) * far
    return CellConfig.from_dict(tree)
