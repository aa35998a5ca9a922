"""Contact manifolds: clipping of the features that touch, and reduction to four points."""
