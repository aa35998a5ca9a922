"""Broad phase: the pairs of bodies that may touch, kept over several steps."""
