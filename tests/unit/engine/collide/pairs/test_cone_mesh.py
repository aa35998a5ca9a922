"""How far a cone is from a mesh: as brute force over all triangles says."""

from __future__ import annotations

from mesh_contacts import check_distances


def test_the_least_gap_is_the_distance_of_the_nearest_triangle() -> None:
    check_distances("cone")
