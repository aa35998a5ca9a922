"""The two tangents of a contact from its normal, after Duff et al. 2017.

"Building an orthonormal basis, revisited": (n, t1, t2) is right-handed, orthonormal, and continuous
but at n = -z. Written once for kernels, in which the arguments are numbers, and for logs, in which
they are columns: both have the same bits. side: 1 where z >= 0, else -1.
"""

from __future__ import annotations

from typing import Any


def first_tangent(x: Any, y: Any, z: Any, side: Any) -> tuple[Any, Any, Any]:
    """Return t1 of the unit normal (x, y, z)."""
    a = -1.0 / (side + z)
    return 1.0 + side * x * x * a, side * (x * y * a), -side * x


def second_tangent(x: Any, y: Any, z: Any, side: Any) -> tuple[Any, Any, Any]:
    """Return t2 = n x t1."""
    a = -1.0 / (side + z)
    return x * y * a, side + y * y * a, -y
