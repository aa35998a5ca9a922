"""How long arrows of forces are drawn, and the sentence that tells the scale.

A resting weight of 10 N and an impact of 2 kN are in the same recording. The arrow of the typical
lasting contact gets a readable length; longer ones are cut and coloured, never shrunk in secret.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from lavendersim.replay.joint_forces import has_joints
from lavendersim.replay.shapes import DrawnBody

CONTACT_KEY = ("body_a", "body_b", "feature")  # equal from step to step while a contact lasts
LASTING_SHARE = 0.1  # of the longest contact's loaded steps

TYPICAL_LENGTH = 0.25  # of the scene's diagonal: seen beside a body, smaller than the scene
OF_CONTACTS = "contact forces"
CUT_LENGTH = 0.5  # of the scene's diagonal: still inside the picture
LARGEST_SCENE = 16.0  # bodies: in a larger one arrows would hide the small bodies that they act on


class ForceScale(NamedTuple):
    """One metre of arrow is `newtons_per_metre`; arrows end at `cut` [m]; `any_cut`: some do."""

    newtons_per_metre: float
    cut: float
    any_cut: bool
    whose: str = OF_CONTACTS

    @property
    def label(self) -> str:
        """The scale in words, for the title of the view."""
        ruler = f"{self.whose}: 1 m = {self.newtons_per_metre:g} N"
        limit = f", cut and red over {self.cut * self.newtons_per_metre:.3g} N"
        return ruler + (limit if self.any_cut else "")

    def arrows(
        self, normal: npt.NDArray[np.float64], force: npt.NDArray[np.float64]
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.bool_]]:
        """Arrow vectors [m] of forces [N] along unit normals (rows, 3), and which ones are cut."""
        length = np.asarray(force) / self.newtons_per_metre
        cut = np.abs(length) > self.cut
        return normal * np.clip(length, -self.cut, self.cut)[:, None], cut


def scene_size(diagonal: float, bodies: Sequence[DrawnBody]) -> float:
    """Return the size [m] that arrows are a share of: of the room, or of its bodies' usual size."""
    sizes = [2.0 * body.bounding_radius for body in bodies if not body.fixed]
    sizes = [size for size in sizes if size > 0.0]
    return min(diagonal, LARGEST_SCENE * float(np.median(sizes))) if sizes else diagonal


def force_scale(contact: npt.NDArray[Any], diagonal: float) -> ForceScale:
    """Choose the scale for a recording's contacts and the scene's diagonal [m].

    Typical is the largest of the median forces of the contacts that last. Where a body rests that
    is its weight, however hard it landed; where it only bounces, its impacts.
    """
    force = np.asarray(contact["force_n"])
    loaded = np.isfinite(force) & (force > 0)
    force = force[loaded]
    typical = 1.0
    if len(force):
        # Other engines name no features: the contacts of a pair are then taken together.
        named = [name for name in CONTACT_KEY if name in (contact.dtype.names or ())]
        keys = np.stack([contact[name][loaded] for name in named], axis=1)
        _, group, count = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
        contacts = np.split(force[np.argsort(group.ravel())], np.cumsum(count)[:-1])
        shortest = LASTING_SHARE * count.max()
        typical = max(float(np.median(own)) for own in contacts if len(own) >= shortest)
    newtons_per_metre = _round(typical / (TYPICAL_LENGTH * diagonal))
    cut = CUT_LENGTH * diagonal
    any_cut = bool((force > cut * newtons_per_metre).any())
    return ForceScale(newtons_per_metre, cut, any_cut, _whose(contact))


def _whose(contact: npt.NDArray[Any]) -> str:
    if not has_joints(contact):
        return OF_CONTACTS
    alone = bool((contact["joint"] > 0).all())
    return "forces of joints" if alone else "forces of contacts and joints"


def _round(value: float) -> float:
    """The nearest of 1, 2, 3, 5 times a power of ten, so that the label can be used as a ruler."""
    power = math.floor(math.log10(value))
    candidates = [
        digit * 10.0**exponent for exponent in (power, power + 1) for digit in (1, 2, 3, 5)
    ]
    return min(candidates, key=lambda candidate: abs(math.log(candidate / value)))
