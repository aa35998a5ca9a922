"""The URDF from which viewers draw the geometry of a scene.

Links are named as the bodies and stand in the frames that /tf moves. A plane is a thin box whose
top face is the plane; it is placed against the plane body's own pose, whatever that is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from lavendersim.cell import CellBody, CellShape, Plane
from lavendersim.trace.layout import root_frame
from lavendersim.trace.urdf_visuals import PLANE_THICKNESS, Matrix, Visual, visuals

__all__ = ["PLANE_THICKNESS", "robot_description"]

# Okabe and Ito, without the two that contacts are drawn in
PALETTE = ((0, 114, 178), (230, 159, 0), (0, 158, 115), (204, 121, 167), (240, 228, 66))
STATIC_COLOUR = (170, 170, 170)
# A viewer makes an entity of each primitive. Hulls have dozens; beyond this they are left out.
MOST_VISUALS = 20_000
SPECIAL: Final = frozenset("&<>\"'\n\r\t")  # in XML's attributes


# The cells of a sweep look alike: descriptions by all that they show, the last few. Of shapes equal
# ones are mostly one object, and 0.0 is not -0.0: by the ids of those that stand beside the text.
MOST_KNOWN: Final = 8
_known: dict[Any, tuple[str, list[CellShape]]] = {}


def robot_description(bodies: Mapping[str, CellBody], poses: Matrix) -> str:
    """Return the URDF of the bodies of a scene; poses: (bodies, 7), the first ones."""
    shapes = [body.shape for body in bodies.values()]
    looks = [(name, body.fixed, body.kinematic) for name, body in bodies.items()]
    shown = tuple(looks), tuple(map(id, shapes)), poses.tobytes()
    known = _known.get(shown)
    if known is None:
        if len(_known) >= MOST_KNOWN:
            _known.clear()
        known = _known[shown] = _described(bodies, poses), shapes
    return known[0]


def _quoted(text: str) -> str:
    """Return a text as the value of an attribute, in quotes."""
    if SPECIAL.isdisjoint(text):
        return f'"{text}"'
    from xml.sax.saxutils import quoteattr  # late: it imports what speaks HTTP

    return quoteattr(text)


def _described(bodies: Mapping[str, CellBody], poses: Matrix) -> str:
    world = root_frame(list(bodies))
    lines = ['<?xml version="1.0"?>', '<robot name="scene">', f"  <link name={_quoted(world)}/>"]
    side = _plane_side(poses)
    left = MOST_VISUALS
    for index, (name, body) in enumerate(bodies.items()):
        immovable = body.fixed or isinstance(body.shape, Plane)
        colour = STATIC_COLOUR if immovable else PALETTE[index % len(PALETTE)]
        drawn = visuals(body.shape, poses[index], side)
        if len(drawn) > max(1, left):
            drawn = []
        left -= len(drawn)
        lines += [f"  <link name={_quoted(name)}>", *_visuals(name, drawn, colour), "  </link>"]
        still = immovable and not body.kinematic
        lines += _joint(world, name, "fixed" if still else "floating")
    return "\n".join([*lines, "</robot>", ""])


def _plane_side(poses: Matrix) -> float:
    """Return the side of drawn planes [m]: four times as far as any body stands from the origin."""
    return 4.0 * max([0.5, *(float(np.linalg.norm(pose[:3])) for pose in poses)])


def _joint(parent: str, child: str, kind: str) -> list[str]:
    return [
        f'  <joint name={_quoted(parent + " to " + child)} type="{kind}">',
        f"    <parent link={_quoted(parent)}/><child link={_quoted(child)}/>",
        "  </joint>",
    ]


def _visuals(name: str, drawn: Sequence[Visual], colour: tuple[int, int, int]) -> list[str]:
    rgba = _quoted(" ".join(f"{channel / 255:.3f}" for channel in colour) + " 1")
    lines = []
    for number, visual in enumerate(drawn, start=1):
        # the visual's name becomes part of the viewer's entity path
        called = _quoted(name if len(drawn) == 1 else f"{name} {number}")
        lines += [
            f"    <visual name={called}>{visual.origin}<geometry>{visual.geometry}</geometry>",
            f"      <material name={_quoted(name)}><color rgba={rgba}/></material>",
            "    </visual>",
        ]
    return lines
