"""Points of `/contacts`, for viewers: where contacts are, their normals, force and penetration.

    point | x y z, on a grid | nx ny nz force_n penetration, cut | red green blue alpha |

Numbers are float32. Digits that nobody reads off a picture do not compress, so they are cut: what a
contact is to the last bit stands in `/contact_columns`, column by column.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import lru_cache
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.trace.layout import PackedField
from lavendersim.trace.message_form import columns_of_words, words_of
from lavendersim.trace.schema import COLOURS, NUMERIC_TYPES
from lavendersim.trace.wire import Bytes, Rows

# Okabe and Ito's colour-blind safe set
LOADED = (213, 94, 0, 255)  # vermilion: the contact carries an impulse
UNLOADED = (86, 180, 233, 255)  # sky blue: it does not

# A grid [m], for a scene may be far from the origin: this share of the thinnest body.
POSITION: Final = ("x", "y", "z")
SHARE: Final = 1.0 / 1024.0
# Of a float32's 23 bits of mantissa these keep 9, to one in five hundred.
ROUGHLY: Final = ("nx", "ny", "nz", "force_n", "penetration")
KEPT_BITS: Final = 9
_KEPT = np.uint32(0xFFFFFFFF << (23 - KEPT_BITS) & 0xFFFFFFFF)


class PointForm(NamedTuple):
    """What stands in a point."""

    fields: tuple[PackedField, ...]  # x y z first
    names: tuple[str, ...]  # columns, four bytes each, then the colour
    size: int  # [B]


@lru_cache(maxsize=64)
def point_form(row: np.dtype[Any]) -> PointForm:
    """Return the form of the points of contacts; row: the engine's. TypeError without a place."""
    given = row.names or ()
    missing = [axis for axis in POSITION if axis not in given]
    if missing:
        raise TypeError(f"contacts lack the columns {missing}")
    names = (*POSITION, *(name for name in ROUGHLY if name in given))
    fields = [PackedField(name, 4 * k, NUMERIC_TYPES["f4"]) for k, name in enumerate(names)]
    end = 4 * len(names)
    fields += [PackedField(c, end + i, NUMERIC_TYPES["u1"]) for i, c in enumerate(COLOURS)]
    return PointForm(tuple(fields), names, end + len(COLOURS))


def grid_of(thicknesses: Iterable[float]) -> float:
    """Return the grid of a scene [m], a power of two; of bodies' thicknesses [m].

    0 where there is none: positions have the digits of a float32.
    """
    thin = min((one for one in thicknesses if one > 0.0), default=0.0) * SHARE
    return 2.0 ** math.floor(math.log2(thin)) if thin > 0.0 else 0.0


def lay_points(
    form: PointForm,
    data: Bytes,
    starts: Rows,
    counts: Rows,
    contacts: NDArray[Any],
    grid: float,
) -> None:
    """Write contacts as points; beyond float32 a number is shown as infinite.

    data: bytes of a chunk, which has room. starts, counts: for each step where its points begin,
    and how many contacts it has. contacts: of these steps. grid: [m] of positions.
    """
    from lavendersim.engine.point_kernel import lay_points as kernel  # late: numba

    if len(contacts) == 0:
        return
    columns, impulse = _places(form, contacts.dtype)
    floats = np.empty(len(columns), np.float32)
    kernel()(
        data,
        (starts, counts),
        words_of(contacts).view(np.float64),
        columns,
        (grid, impulse, (_KEPT, _word(LOADED), _word(UNLOADED))),
        (floats, floats.view(np.uint32)),
    )


@lru_cache(maxsize=64)
def _places(form: PointForm, row: np.dtype[Any]) -> tuple[NDArray[np.int64], int]:
    """Return where the columns of points stand in the words of rows; and the impulse, -1: not."""
    place = columns_of_words(row)
    return np.array([place[name] for name in form.names], np.int64), place.get("impulse_n", -1)


def _word(colour: tuple[int, int, int, int]) -> np.uint32:
    """Return red green blue alpha as one little-endian word."""
    return np.uint32(int.from_bytes(bytes(colour), "little"))
