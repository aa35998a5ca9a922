"""Bodies and their first poses enter, the URDF that viewers draw geometry from leaves.

Links are named as the bodies and stand in the frames that /tf moves. A plane is a thin box whose
top face is the plane; it is placed against the plane body's own pose, whatever that is.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from lavendersim.trace.layout import root_frame

PLANE_THICKNESS = 0.02  # m; thin beside any body, thick enough to be seen edge-on
# Okabe and Ito, without the two that contacts are drawn in
PALETTE = ((0, 114, 178), (230, 159, 0), (0, 158, 115), (204, 121, 167), (240, 228, 66))
STATIC_COLOUR = (170, 170, 170)

Matrix = NDArray[np.float64]


def robot_description(
    bodies: Sequence[str], shapes: Mapping[str, Mapping[str, Any]], poses: Matrix
) -> str:
    """Return the URDF of a scene.

    shapes: body -> resolved body config (`shape`, `fixed`). poses: (bodies, 7), the first ones.
    A shape this knows no geometry for is a link without a visual.
    """
    world = root_frame(bodies)
    lines = ['<?xml version="1.0"?>', '<robot name="scene">', f"  <link name={quoteattr(world)}/>"]
    side = _plane_side(poses)
    for index, name in enumerate(bodies):
        config = shapes.get(name, {})
        shape = config.get("shape", {})
        static = bool(config.get("fixed")) or shape.get("kind") == "plane"
        colour = STATIC_COLOUR if static else PALETTE[index % len(PALETTE)]
        lines += [f"  <link name={quoteattr(name)}>", *_visual(name, shape, poses[index], side)]
        if lines[-1].startswith("    <visual"):
            rgba = " ".join(f"{channel / 255:.3f}" for channel in colour)
            lines += [
                f"      <material name={quoteattr(name)}><color rgba={quoteattr(rgba + ' 1')}/>"
                "</material>",
                "    </visual>",
            ]
        lines += ["  </link>", *_joint(world, name, "fixed" if static else "floating")]
    return "\n".join([*lines, "</robot>", ""])


def _plane_side(poses: Matrix) -> float:
    """Return the side of drawn planes [m]: four times as far as any body stands from the origin."""
    return 4.0 * max([0.5, *(float(np.linalg.norm(pose[:3])) for pose in poses)])


def _joint(parent: str, child: str, kind: str) -> list[str]:
    return [
        f'  <joint name={quoteattr(parent + " to " + child)} type="{kind}">',
        f"    <parent link={quoteattr(parent)}/><child link={quoteattr(child)}/>",
        "  </joint>",
    ]


def _visual(name: str, shape: Mapping[str, Any], pose: Matrix, side: float) -> list[str]:
    kind = shape.get("kind")
    origin = '<origin xyz="0 0 0" rpy="0 0 0"/>'
    if kind == "sphere":
        geometry = f'<sphere radius="{float(shape["radius"])!r}"/>'
    elif kind == "box":
        geometry = f'<box size="{_numbers(shape["size"])}"/>'
    elif kind == "plane":
        geometry = f'<box size="{_numbers((side, side, PLANE_THICKNESS))}"/>'
        origin = _plane_origin(shape, pose)
    else:
        return []
    # the visual's name becomes part of the viewer's entity path
    head = f"    <visual name={quoteattr(name)}>{origin}<geometry>{geometry}</geometry>"
    return [head]


def _plane_origin(shape: Mapping[str, Any], pose: Matrix) -> str:
    """Return where the plane's box stands in the plane body's frame."""
    normal = np.array([float(v) for v in shape["normal"]])
    normal /= np.linalg.norm(normal)
    centre = normal * (float(shape["offset"]) - PLANE_THICKNESS / 2)
    body = _rotation(pose[3:])
    box = body.T @ _facing(normal)
    position = body.T @ (centre - pose[:3])
    roll = math.atan2(box[2, 1], box[2, 2])
    pitch = math.asin(min(1.0, max(-1.0, -float(box[2, 0]))))
    yaw = math.atan2(box[1, 0], box[0, 0])
    return f'<origin xyz="{_numbers(position)}" rpy="{_numbers((roll, pitch, yaw))}"/>'


def _facing(normal: Matrix) -> Matrix:
    """Return a rotation that takes z to `normal`."""
    helper = np.eye(3)[int(np.argmin(np.abs(normal)))]
    x = np.cross(helper, normal)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(normal, x), normal])


def _rotation(q: Matrix) -> Matrix:
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _numbers(values: Any) -> str:
    return " ".join(repr(float(value)) for value in values)
