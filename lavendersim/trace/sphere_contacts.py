"""Where contacts of spheres are expected, in closed form, from the poses at the start of a step.

    two spheres       n = d / |d|, d = x_b - x_a; phi = |d| - r_a - r_b; p = x_a + (r_a + phi / 2) n
    plane and sphere  n, the plane's;  phi = n . x_b - offset - r;       p = x_b - (r + phi / 2) n

In the order of operations of the engine (`collide/pairs`), each of which IEEE 754 rounds in one way
alone: where the engine found a contact so, it is expected to the last bit. What a log holds of the
bodies is a row for each: radius of a sphere, else 0; normal and offset of a plane, else 0; and
where it is at the start of the first step.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.cell.shapes import CellShape, Plane
from lavendersim.cell.shapes.sphere import Sphere
from lavendersim.geometry.shapes import half_space
from lavendersim.trace.scratch import scratch

Floats = NDArray[np.float64]
RADIUS, NORMAL, OFFSET, POSITION = 0, slice(1, 4), 4, slice(5, 8)
FIELDS: Final = 8
COLUMNS: Final = ("x", "y", "z", "nx", "ny", "nz", "separation")


def body_table(shapes: Iterable[CellShape]) -> Floats | None:
    """Return a row for each body (n, FIELDS), positions still 0; None where none is a sphere."""
    shapes = list(shapes)
    table = np.zeros((len(shapes), FIELDS))
    for row, shape in zip(table, shapes, strict=True):
        if isinstance(shape, Sphere):
            row[RADIUS] = shape.radius
        elif isinstance(shape, Plane):
            plane = half_space(shape)
            row[NORMAL], row[OFFSET] = plane.normal, plane.offset
    return table if (table[:, RADIUS] > 0.0).any() else None


class Starts(NamedTuple):
    """The bodies of some contacts, and where each is at the start of their steps."""

    bodies: Floats  # (n, FIELDS)
    positions: Floats  # (steps, n, 3) [m]
    step: NDArray[np.intp]  # of each contact: which of these steps it is of


class Expected(NamedTuple):
    """Contacts as they are expected."""

    columns: dict[str, Floats]  # by COLUMNS; 0 of contacts that are not known
    known: NDArray[np.bool_]  # of two spheres, or of a plane and a sphere


def expected_contacts(
    body_a: NDArray[np.int64], body_b: NDArray[np.int64], starts: Starts
) -> Expected:
    """Return contacts of these bodies as they are expected; those with other bodies not known."""
    count = len(starts.bodies)
    among = (body_a >= 0) & (body_a < count) & (body_b >= 0) & (body_b < count)
    one, other = np.where(among, body_a, 0), np.where(among, body_b, 0)
    is_sphere = starts.bodies[:, RADIUS] > 0.0
    is_plane = np.any(starts.bodies[:, NORMAL] != 0.0, axis=1)
    spheres = among & is_sphere[one] & is_sphere[other]
    on_plane = among & is_plane[one] & is_sphere[other]
    table = np.zeros((len(COLUMNS), len(body_a)))
    with np.errstate(all="ignore"):  # what is not finite stays so
        for rows, contacts in ((spheres, _of_spheres), (on_plane, _on_plane)):
            at = np.flatnonzero(rows)
            if len(at):
                mine = starts._replace(step=starts.step[at])
                for column, numbers in zip(table, contacts(one[at], other[at], mine), strict=True):
                    column[at] = np.where(np.isnan(numbers), 0.0, numbers)  # of many bit patterns
    return Expected(dict(zip(COLUMNS, table, strict=True)), spheres | on_plane)


def place_contacts(keys: NDArray[np.int64], order: NDArray[np.intp], starts: Starts) -> Expected:
    """Return the same of contacts in an order, by a kernel: (k, n) keys, bodies first.

    In memory that is used again when this thread asks again.
    """
    from lavendersim.engine.expected_kernel import place_contacts as kernel  # late: numba

    table = scratch("placed", (len(COLUMNS) + 1, len(order)), np.float64)
    kernel()(keys, order, starts.step, starts.bodies, starts.positions, table)
    return Expected(dict(zip(COLUMNS, table, strict=False)), table[-1] == 1.0)


def _of_spheres(a: NDArray[np.int64], b: NDArray[np.int64], starts: Starts) -> list[Floats]:
    radius = starts.bodies[:, RADIUS]
    from_a, to_b = _positions(a, starts), _positions(b, starts)
    d = [to - begin for begin, to in zip(from_a, to_b, strict=True)]
    distance = np.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
    n = [one / distance for one in d]
    phi = distance - radius[a] - radius[b]
    reach = radius[a] + 0.5 * phi
    return [*(x + reach * one for x, one in zip(from_a, n, strict=True)), *n, phi]


def _on_plane(a: NDArray[np.int64], b: NDArray[np.int64], starts: Starts) -> list[Floats]:
    radius, offset = starts.bodies[b, RADIUS], starts.bodies[a, OFFSET]
    n, centre = list(starts.bodies[a, NORMAL].T), _positions(b, starts)
    phi = n[0] * centre[0] + n[1] * centre[1] + n[2] * centre[2] - offset - radius
    reach = radius + 0.5 * phi
    return [*(x - one * reach for x, one in zip(centre, n, strict=True)), *n, phi]


def _positions(body: NDArray[np.int64], starts: Starts) -> list[Floats]:
    """Return x, y and z of the body of each contact."""
    place = starts.step * starts.positions.shape[1] + body
    flat = starts.positions.reshape(-1, 3)
    return [flat[:, axis][place] for axis in range(3)]
