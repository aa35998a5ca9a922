"""Newton's method on the augmented Lagrangian, factorised over the bodies; see `method`."""
