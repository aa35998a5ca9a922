"""Projection onto a disc, of one vector across a contact or of eight side by side."""

from __future__ import annotations

from typing import Any

from ...compile import kernel
from ...spec import Spec
from .lanes import root, where_greater


def make_project_disc(spec: Spec) -> Any:
    """Return `kernel(one, two, limit)`: the nearest points of discs of radius `limit`."""

    def project_lanes(one, two, limit):
        squared, disc = one * one + two * two, limit * limit
        scale = limit / root(squared)
        return (
            where_greater(squared, disc, one * scale, one),
            where_greater(squared, disc, two * scale, two),
        )

    return kernel(project_lanes, spec)
