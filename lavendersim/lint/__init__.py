"""Scenes that can be simulated and are probably not meant: each a warning with its place.

Experiment -> a few telling cells -> rules -> warnings, in the order of the file
"""

from lavendersim.lint.suspicions import suspicions, warn

__all__ = ["suspicions", "warn"]
