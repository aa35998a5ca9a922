"""Signed separation, normal and witness points of two convex bodies: GJK and EPA."""
