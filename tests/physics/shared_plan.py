"""Plans that scenes of many files share, as the cells of a sweep do.

A kernel of these takes five to fifteen seconds to compile, and the scenes differ in little. What a
shared plan has beside what a scene requires is idle there and changes no bit (tests/composition:
each effect alone, and random subsets); so it was for every scene of these files when it was shared.
Some effects do change something and are never added. With `impact_order` an impact of one pair
alone has its rows in its own step and none in the next one; with `rotation` places of frictionless
balls that slide differ in their last bit.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

from lavendersim.engine.spec import Spec
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.plan import CHOICES, Plan, plan_of_cell

# Whatever most of these files require of lavender's own numerics, in one scene.
TURNING = """
scene:
  surfaces:
    one: {friction: 0.5, restitution: 0.5, torsional_friction: 0.001, rolling_friction: 0.001}
    two: {friction: 0}
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
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1
      position: [1, 0, 1]
      surface: one
      drag: {linear: 1}
    low: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [2, 0, 1], surface: two}
    dumbbell:
      shape:
        kind: compound
        parts:
          - {shape: {kind: sphere, radius: 0.1}, position: [0, -0.3, 0]}
          - {shape: {kind: sphere, radius: 0.1}, position: [0, 0.3, 0]}
      mass: 1
      position: [3, 0, 1]
      surface: one
  forces:
    - {body: ball, force: [1, 0, 0]}
    - {body: ball, force: [1, 0, 0], factor: {kind: ramp}}
duration: 1
"""
# Balls that nothing turns.
BALLS = """
scene:
  surfaces: {one: {restitution: 0.5}}
  bodies:
    floor: {shape: {kind: plane}, surface: one}
    fast:
      shape: {kind: sphere, radius: 0.1}
      mass: 1
      position: [0, 0, 1]
      velocity: [19, 0, 0]
      surface: one
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [1, 0, 1], surface: one}
duration: 1
"""
# Contacts that give way as springs do.
SPRINGY = """
scene:
  surfaces:
    one: {friction: 0.5, restitution: 0.5, compliance: 1.0e-6}
    two: {compliance: 1.0e-6}
  bodies:
    floor: {shape: {kind: plane}, surface: one}
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
# What ropes and springs tie, some of it over a floor that gives way to some of it.
LINKED = """
scene:
  surfaces:
    one: {friction: 0.5, restitution: 0.5}
    two: {friction: 0, compliance: 1.0e-6}
  bodies:
    floor: {shape: {kind: plane}, surface: one}
    brick:
      shape: {kind: box, size: [0.2, 0.1, 0.3]}
      mass: 1
      position: [0, 0, 1]
      velocity: [9, 0, 0]
      angular_velocity: [1, 2, 3]
      surface: one
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [1, 0, 1], surface: one}
    low: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [2, 0, 1], surface: two}
    high: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [2, 0, 3], surface: two}
  connections:
    rope: {kind: rope, between: [brick, ball]}
  springs:
    - {a: brick, b: high, stiffness: 1, rest_length: 1}
duration: 1
"""
# As long as an accuracy allows.
ACCURATE = """
scene:
  surfaces:
    one: {friction: 0.5, restitution: 0.5, compliance: 1.0e-6}
    two: {friction: 0}
  bodies:
    floor: {shape: {kind: plane}, surface: one}
    table:
      shape: {kind: cylinder, radius: 1, length: 0.1}
      kinematic: true
      angular_velocity: [0, 0, 1]
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
  springs:
    - {a: brick, b: low, stiffness: 1, rest_length: 1}
  forces:
    - {body: ball, force: [1, 0, 0], factor: {kind: ramp}}
numerics: {accuracy: 1.0e-4}
duration: 1
"""
# By the chapter's numerics: balls that nothing turns, and bodies that turn.
CHAPTER_BALLS = """
scene:
  surfaces: {one: {restitution: 0.5, compliance: 1.0e-6}}
  bodies:
    floor: {shape: {kind: plane}, surface: one}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1], surface: one}
    other: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [1, 0, 1], surface: one}
numerics: {preset: chapter}
duration: 1
"""
CHAPTER_TURNING = """
scene:
  surfaces:
    one: {friction: 0.5, restitution: 0.5, torsional_friction: 0.001, rolling_friction: 0.001}
    two: {friction: 0}
  bodies:
    floor: {shape: {kind: plane}, surface: one}
    brick:
      shape: {kind: box, size: [0.2, 0.1, 0.3]}
      mass: 1
      position: [0, 0, 1]
      angular_velocity: [1, 2, 3]
      surface: one
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [1, 0, 1], surface: one}
    low: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [2, 0, 1], surface: two}
numerics: {preset: chapter}
duration: 1
"""
NEVER_ADDED = {"impact_order", "rotation"}  # nor what needs the former
BALLS_PAIRS = ("sphere_plane", "sphere_sphere")
PAIRS = (
    *("box_box", "box_plane", "capsule_box", "capsule_plane", "cylinder_box", "cylinder_cylinder"),
    *("cylinder_plane", "hull_plane", "sphere_box", "sphere_cylinder", *BALLS_PAIRS),
)
SPRINGY_PAIRS = ("box_plane", "sphere_box", *BALLS_PAIRS)
LINKED_PAIRS = ("box_box", *SPRINGY_PAIRS)
ACCURATE_PAIRS = ("cylinder_box", "cylinder_plane", "sphere_cylinder", *LINKED_PAIRS)
SHARED: dict[str, tuple[tuple[str, ...], ...]] = {  # shape pairs, and more effects, by the scene
    TURNING: (PAIRS, ("prescribed_motion",)),
    BALLS: (BALLS_PAIRS, ("broad_phase",)),
    SPRINGY: (SPRINGY_PAIRS, ()),
    LINKED: (LINKED_PAIRS, ()),
    ACCURATE: (ACCURATE_PAIRS, ("sleeping",)),
    CHAPTER_BALLS: (BALLS_PAIRS, ("broad_phase", "sleeping")),
    CHAPTER_TURNING: (LINKED_PAIRS, ("frictionless_contact",)),
}
BY_EFFECTS = CHOICES.index("sleeping")  # a choice that says no more than that the effect is there


class _Shared(NamedTuple):
    """A plan that scenes share: what is compiled, and the laws that it chooses."""

    spec: Spec
    choices: tuple[Any, ...]

    def serves(self, plan: Plan) -> bool:
        """Whether a plan chooses the same laws, and all else that it has is idle in it."""
        has, required = set(self.spec.effects), set(plan.spec.effects)
        return (
            _laws(plan.choices) == _laws(self.choices)
            and set(plan.spec.shape_pairs) <= set(self.spec.shape_pairs)
            and required <= has
            and NEVER_ADDED & required == NEVER_ADDED & has
        )


def shared_spec(plan: Plan) -> Spec:
    """Return what is compiled for a plan: a shared one where that chooses the same laws."""
    for shared in _shared():
        if shared.serves(plan):
            return shared.spec
    return plan.spec


def _laws(choices: tuple[Any, ...]) -> tuple[Any, ...]:
    return choices[:BY_EFFECTS] + choices[BY_EFFECTS + 1 :]


@cache
def _shared() -> list[_Shared]:
    found = []
    for text, (pairs, effects) in SHARED.items():
        plan = plan_of_cell(load_experiment_text(text, "shared.yaml").cells()[0])
        spec = plan.spec.including(*effects)._replace(shape_pairs=tuple(sorted(pairs)))
        found.append(_Shared(spec, plan.choices))
    return found
