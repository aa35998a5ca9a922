"""The law that each step of a log breaks, whichever engine made it: from poses and velocities.

poses, velocities ──► momentum: what forces do not explain of its change, by bodies
poses ──► contacts: points that may have pushed, by our collision detection
both ──► step_laws: impulses within the laws that explain it best, and what is left
"""
