"""Collision detection: from bodies and their poses to contact points.

broad      which pairs of bodies may touch: a bounding volume hierarchy over swept bounds
convex     the signed separation of two convex bodies: GJK and EPA on support mappings
manifold   from the features that touch to at most four contact points: clipping and reduction
pairs      one file per pair of shapes, its manifold in closed form or by way of `convex`

`narrow_phase` calls the pairs that a scene needs; `swept` finds the time of impact of fast ones;
`scratch` is the memory that all of them share.
"""

from .pairs import SHAPE_PAIRS
from .shape_pair import ShapePair

__all__ = ["SHAPE_PAIRS", "ShapePair"]
