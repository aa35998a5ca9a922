"""Scenes that can be simulated and are probably not meant: each a warning with its place.

experiment -> the first cell with each swept value -> rules -> warnings, in the file's order
"""

from lavendersim.lint.suspicions import suspicions, warn

__all__ = ["suspicions", "warn"]
