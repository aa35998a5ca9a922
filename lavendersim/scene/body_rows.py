"""The engine's body table and its tables of hulls, filled from a cell.

Columns that effects bring are filled where they are present.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Final

import numpy as np

from lavendersim.cell import (
    Cavity,
    CellBody,
    CellHull,
    CellMesh,
    CellPart,
    CellScene,
    CellShape,
    Convex,
    Plane,
)
from lavendersim.engine.collide.convex.hull_geometry import (
    HullGeometry,
    Polyhedron,
    hull_geometry,
)
from lavendersim.engine.collide.mesh_tables import MeshTables
from lavendersim.engine.collide.shapes import SHAPES, has_mesh
from lavendersim.engine.effects import EFFECTS
from lavendersim.engine.record_layout import allocate_bodies
from lavendersim.engine.records import PLANE
from lavendersim.engine.spec import Spec
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.quaternions import product
from lavendersim.geometry.rotations import rotation_matrix, unit_quaternion
from lavendersim.geometry.shapes import bounding_radius

from .colliders import Collider

MATRIX: Final = tuple(f"r{i}{j}" for i in range(3) for j in range(3))  # of a body's record
OWN_VALUES: Final = tuple(one.body_values for one in EFFECTS if one.body_values)


def pose_of(body: CellBody) -> np.ndarray:
    """Return x y z qw qx qy qz of a body; planes stand in the origin."""
    pose = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    if not isinstance(body.shape, Plane):
        pose[:3] = body.position
        pose[3:] = body.orientation
        pose[3:] /= np.linalg.norm(pose[3:])
    return pose


def part_pose(pose: np.ndarray, part: CellPart) -> np.ndarray:
    """Return the pose of a part in the world by that of its owner."""
    position = pose[:3] + rotation_matrix(pose[3:]) @ np.asarray(part.position, float)
    w, x, y, z = pose[3:].tolist()
    turn = product((w, x, y, z), part.orientation)
    return np.concatenate([position, unit_quaternion(turn)])


def body_table(
    spec: Spec, rows: Sequence[Collider], poses: np.ndarray
) -> tuple[np.ndarray, HullGeometry, MeshTables | None]:
    """Return the records of all rows, and the tables of their hulls and meshes.

    Equal hulls share one, and the same mesh; None where there is no mesh.

    poses: (bodies, 7), those of the bodies alone.
    """
    bodies = allocate_bodies(spec, len(rows))
    hulls: dict[str, int] = {}
    polyhedra: list[Polyhedron] = []
    for k, (record, row) in enumerate(zip(bodies, rows, strict=True)):
        pose = poses[row.owner]
        _fill_shape(record, row.shape)
        if isinstance(row.shape, CellHull):
            known = len(hulls)
            record["hull"] = hulls.setdefault(repr(row.shape.points), known)
            if len(hulls) > known:
                polyhedra.append((np.array(row.shape.points, float), row.shape.faces))
        if row.part is None:
            _fill_mass(record, row.body)
        else:
            _fill(record, ("px", "py", "pz"), row.part.position)
            _fill(record, ("pqw", "pqx", "pqy", "pqz"), row.part.orientation)
            pose = part_pose(pose, row.part)
        _fill(record, ("owner",), (row.owner,))
        fill_effects(record, row.body)
        _fill(record, ("x", "y", "z"), pose[:3])
        orient(record, pose[3:])
        assert k == row.owner or row.part is not None
    return bodies, hull_geometry(polyhedra), _with_meshes(spec, rows, bodies)


def _with_meshes(spec: Spec, rows: Sequence[Collider], bodies: np.ndarray) -> MeshTables | None:
    """Return the tables of meshes that something may touch, and write where each stands there."""
    if not has_mesh(spec):
        return None
    from .triangle_tables import mesh_tables  # few scenes need it

    meshes = {id(row.shape): row.shape for row in rows if isinstance(row.shape, CellMesh)}
    tables, spans = mesh_tables(list(meshes.values()))
    span_of = dict(zip(meshes, spans, strict=True))
    for record, row in zip(bodies, rows, strict=True):
        if isinstance(row.shape, CellMesh):
            record["first_node"], record["last_node"] = span_of[id(row.shape)]
    return tables


def orient(record: np.void, quaternion: np.ndarray) -> None:
    """Write a unit quaternion w x y z into a body's record, and its matrix."""
    _fill(record, ("qw", "qx", "qy", "qz"), quaternion)
    if "r00" in (record.dtype.names or ()):
        _fill(record, MATRIX, rotation_matrix(quaternion).ravel().tolist())


def fill_effects(record: np.void, body: CellBody) -> None:
    """Fill the fields that effects bring, by the keys that they declare."""
    for body_values in OWN_VALUES:
        values = body_values(body)
        _fill(record, values, values.values())


def fill_periods(bodies: np.ndarray, scene: CellScene) -> None:
    """Fill the periods of the cell, of all bodies but planes, where bodies may meet images."""
    if scene.periodic is None or "period_x" not in (bodies.dtype.names or ()):
        return
    for axis, period in scene.periodic.periods.items():
        bodies[f"period_{axis}"] = np.where(bodies["shape"] == PLANE, 0.0, period)


def _fill(record: np.void, names: Iterable[str], values: Iterable[Any]) -> None:
    """Fill the fields that the record has."""
    present = record.dtype.names or ()
    for name, value in zip(names, values, strict=True):
        if name in present:
            record[name] = value


def _fill_shape(record: np.void, shape: CellShape) -> None:
    record["shape"] = SHAPES[shape.kind].kind
    record["bound"] = bounding_radius(shape)
    match shape:
        case Plane():
            normal = np.asarray(shape.normal, float)
            record["hx"], record["hy"], record["hz"] = normal / np.linalg.norm(normal)
            record["offset"] = shape.offset
        case Cavity():
            record["hx"] = shape.radius
        case Convex():
            row = shape.row()
            _fill(record, row, row.values())


def _fill_mass(record: np.void, body: CellBody) -> None:
    if is_movable(body):
        assert body.mass is not None
        assert body.inertia is not None
        record["inv_m"] = 1.0 / body.mass
        inverse = (1.0 / moment for moment in body.inertia)
        _fill(record, ("inv_ix", "inv_iy", "inv_iz"), inverse)
