"""Bodies and their first poses enter, the URDF that viewers draw geometry from leaves.

Links are named as the bodies and stand in the frames that /tf moves. A plane is a thin box whose
top face is the plane; it is placed against the plane body's own pose, whatever that is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from lavendersim.trace.layout import root_frame
from lavendersim.trace.urdf_visuals import PLANE_THICKNESS, Matrix, Visual, visuals

__all__ = ["PLANE_THICKNESS", "robot_description"]

# Okabe and Ito, without the two that contacts are drawn in
PALETTE = ((0, 114, 178), (230, 159, 0), (0, 158, 115), (204, 121, 167), (240, 228, 66))
STATIC_COLOUR = (170, 170, 170)
# A viewer makes an entity of each primitive. Hulls have dozens; beyond this they are left out.
MOST_VISUALS = 20_000


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
    left = MOST_VISUALS
    for index, name in enumerate(bodies):
        config = shapes.get(name, {})
        shape = config.get("shape", {})
        immovable = bool(config.get("fixed")) or shape.get("kind") == "plane"
        colour = STATIC_COLOUR if immovable else PALETTE[index % len(PALETTE)]
        drawn = visuals(shape, poses[index], side)
        if len(drawn) > max(1, left):
            drawn = []
        left -= len(drawn)
        lines += [f"  <link name={quoteattr(name)}>", *_visuals(name, drawn, colour), "  </link>"]
        still = immovable and not config.get("kinematic")
        lines += _joint(world, name, "fixed" if still else "floating")
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


def _visuals(name: str, drawn: Sequence[Visual], colour: tuple[int, int, int]) -> list[str]:
    rgba = quoteattr(" ".join(f"{channel / 255:.3f}" for channel in colour) + " 1")
    lines = []
    for number, visual in enumerate(drawn, start=1):
        # the visual's name becomes part of the viewer's entity path
        called = quoteattr(name if len(drawn) == 1 else f"{name} {number}")
        lines += [
            f"    <visual name={called}>{visual.origin}<geometry>{visual.geometry}</geometry>",
            f"      <material name={quoteattr(name)}><color rgba={rgba}/></material>",
            "    </visual>",
        ]
    return lines
