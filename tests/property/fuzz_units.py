"""A drawn scene in another unit of mass: every motion to the bit, every impulse times the ratio.

A power of four rounds nothing, nor does its root: no mass stands in the engine as a number. Lengths
and times do: see `fuzz_constants`. Numbers too near to 0 or to the greatest do round: of runs that
have such nothing is said (`rounds`).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lavendersim.cell import CellConfig

RATIO = 4.0**4
# Keys of a config that are proportional to mass, and those that are to its inverse.
WITH = ("mass", "force", "torque", "stiffness", "damping", "cohesion", "linear", "quadratic")
WITH += ("angular", "inertia", "max_force", "max_torque")
AGAINST = ("compliance",)
# Squares of what is nearer to 0 lose digits, and products of what is larger do.
LEAST, MOST = 1e-70, 1e70


def heavier(config: CellConfig, ratio: float = RATIO) -> CellConfig:
    """Return a cell whose masses are so many times as large, and all that goes with them."""
    tree = config.as_dict()
    scaled = {
        key: _scaled(tree[key], ratio) for key in ("scene", "events", "triggered") if key in tree
    }
    return CellConfig.from_dict({**tree, **scaled})


def _scaled(value: Any, ratio: float) -> Any:
    if isinstance(value, list):
        return [_scaled(one, ratio) for one in value]
    if not isinstance(value, dict):
        return value
    return {
        key: _times(one, ratio) if key in WITH
        else _times(one, 1.0 / ratio) if key in AGAINST
        else _scaled(one, ratio)
        for key, one in value.items()
    }  # fmt: skip


def _times(value: Any, ratio: float) -> Any:
    if value is None:  # of what is fixed, and of surfaces that say nothing
        return None
    return [_times(one, ratio) for one in value] if isinstance(value, list) else ratio * value


def rounds(rows: Any) -> bool:
    """Whether impulses or what moves are too near to 0, or to the greatest number."""
    numbers = np.abs(np.concatenate([rows.pose.ravel(), _impulses(rows).ravel()]))
    return bool(((numbers < LEAST) & (numbers > 0.0)).any() or not (numbers < MOST).all())


def _impulses(rows: Any) -> np.ndarray:
    names = [name for name in rows.contact.dtype.names if "impulse" in name]
    return np.column_stack([rows.contact[name] for name in names])


def differences(one: Any, other: Any, ratio: float = RATIO) -> list[str]:
    """Return what differs of two runs' rows but by the unit."""
    if one.pose.shape != other.pose.shape or len(one.contact) != len(other.contact):
        return ["units: another unit of mass has another number of steps or contacts"]
    if one.pose.tobytes() != other.pose.tobytes():
        step = int(np.argmax((one.pose != other.pose).any(axis=(1, 2))))
        return [f"units: another unit of mass moves otherwise in step {step}"]
    if not np.array_equal(ratio * _impulses(one), _impulses(other)):
        return ["units: an impulse is not proportional to mass"]
    return []
