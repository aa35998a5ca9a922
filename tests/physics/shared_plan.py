"""A plan that scenes of many files share, as the cells of a sweep do.

A kernel of these takes five to ten seconds to compile, and the scenes differ in little. What the
shared plan has beside what a scene requires is idle there and changes no bit (tests/composition:
each effect alone, and random subsets); so it was for every scene of these files when it was shared.
Two effects do change something and are never added: with `impact_order` an impact of one pair alone
has its rows in its own step and none in the next one; with `rotation` places of frictionless balls
that slide differ in their last bit. Scenes of springs have plans of their own.
"""

from __future__ import annotations

from functools import cache

from lavendersim.engine.spec import Spec
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.plan import Plan, plan_of_cell

# Whatever these files require of lavender's own numerics, in one scene.
SCENE = """
scene:
  surfaces: {one: {friction: 0.5, restitution: 0.5}, two: {friction: 0}}
  bodies:
    floor: {shape: {kind: plane}, surface: one}
    belt:
      shape: {kind: box, size: [1, 1, 1]}
      fixed: true
      position: [5, 0, 1]
      surface_velocity: [1, 0, 0]
      surface: one
    lift:
      shape: {kind: box, size: [1, 1, 1]}
      kinematic: true
      velocity: [1, 0, 0]
      position: [9, 0, 1]
      surface: two
    brick:
      shape: {kind: box, size: [0.2, 0.1, 0.3]}
      mass: 1
      position: [0, 0, 1]
      velocity: [9, 0, 0]
      angular_velocity: [1, 2, 3]
      surface: one
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [1, 0, 1], surface: one}
    low: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [2, 0, 1], surface: two}
duration: 1
"""
NEVER_ADDED = {"impact_order", "rotation"}  # nor what needs the former
PAIRS = (
    *("box_box", "box_plane", "capsule_box", "capsule_plane", "cylinder_box", "cylinder_cylinder"),
    *("cylinder_plane", "hull_plane", "sphere_box", "sphere_cylinder", "sphere_plane"),
    "sphere_sphere",
)


def shared_spec(plan: Plan) -> Spec:
    """Return what is compiled for a plan: the shared one where it chooses the same laws."""
    shared, required = _shared(), set(plan.spec.effects)
    if plan.choices != shared.choices or not set(plan.spec.shape_pairs) <= set(PAIRS):
        return plan.spec
    if not NEVER_ADDED <= required <= set(shared.spec.effects):
        return plan.spec
    return shared.spec._replace(shape_pairs=PAIRS)


@cache
def _shared() -> Plan:
    return plan_of_cell(load_experiment_text(SCENE, "shared.yaml").cells()[0])
