"""Modules that no unit test is named after: declarations, each with what it declares."""

from __future__ import annotations

# No function: what is wrong in them is seen where a config, a log or an engine is made of them.
DECLARATIONS = {
    "cell/body.py": "fields of a resolved config",
    "cell/choices.py": "names of choices",
    "cell/engine.py": "fields of a resolved config",
    "cell/numerics.py": "fields of a resolved config",
    "cell/shapes/compound.py": "fields of a resolved config",
    "cell/shapes/plane.py": "fields of a resolved config",
    "engine/solvers/catalogue.py": "a list of declarations",
    "figures/specs/base.py": "fields of a panel's config",
    "figures/specs/catalogue.py": "a union of models",
    "figures/specs/free_rotation.py": "fields of a panel's config",
    "figures/specs/heat_map.py": "fields of a panel's config",
    "figures/specs/histogram.py": "fields of a panel's config",
    "figures/specs/measure_against_axis.py": "fields of a panel's config",
    "figures/specs/measure_by_name.py": "fields of a panel's config",
    "figures/specs/row_against_index.py": "fields of a panel's config",
    "figures/specs/stability_map.py": "fields of a panel's config",
    "measures/specs/catalogue.py": "a union of models",
    "measures/specs/connections.py": "fields of a measure's config",
    "measures/specs/convergence.py": "fields of a measure's config",
    "measures/specs/energy.py": "fields of a measure's config",
    "measures/specs/impact.py": "fields of a measure's config",
    "measures/specs/motion.py": "fields of a measure's config",
    "measures/specs/optimality.py": "fields of a measure's config",
    "measures/specs/overlap.py": "fields of a measure's config",
    "measures/specs/spinning.py": "fields of a measure's config",
    "measures/specs/steady.py": "fields of a measure's config",
    "peers/messages.py": "fields of messages",
    "peers/bullet.py": "a declaration",
    "peers/mujoco.py": "a declaration",
    "peers/rapier.py": "a declaration",
}
