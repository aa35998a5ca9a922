"""Scenes of the physics tests' families of plans (`families_of_plans`): what they require.

Each has whatever most scenes of some files in tests/physics require.
"""

from __future__ import annotations

# Lavender's own numerics.
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
# What joints hold, with every kind, stop and motor, beside contacts.
JOINTED = """
scene:
  surfaces:
    one: {friction: 0.5}
    two: {friction: 0}
  bodies:
    floor: {shape: {kind: plane}, surface: one}
    post: {shape: {kind: sphere, radius: 0.1}, fixed: true, position: [0, 0, 5], surface: one}
    brick:
      shape: {kind: box, size: [0.2, 0.1, 0.3]}
      mass: 1
      position: [0, 0, 1]
      velocity: [9, 0, 0]
      angular_velocity: [1, 2, 3]
      surface: one
    other:
      shape: {kind: box, size: [0.2, 0.1, 0.3]}
      mass: 1
      position: [0, 1, 1]
      surface: one
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [1, 0, 1], surface: one}
    low: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [2, 0, 1], surface: two}
  connections:
    door: {kind: hinge, between: [post, brick], at: [0, 0, 4], axis: [0, 0, 1], limits: [-1, 1]}
    shaft:
      kind: hinge
      between: [brick, other]
      at: [0, 1, 1]
      axis: [0, 0, 1]
      motor: {speed: 1, max_torque: 1}
    point: {kind: ball, between: [brick, ball], at: [0.5, 0, 1]}
  forces:
    - {body: brick, force: [1, 0, 0], frame: body}
    - {body: other, force: [1, 0, 0]}
duration: 1
record: {velocities: true}
"""
# The same where nothing can touch: without contacts there is no order of impacts.
JOINTED_APART = """
scene:
  bodies:
    post: {shape: {kind: sphere, radius: 0.1}, fixed: true, position: [0, 0, 5]}
    brick:
      shape: {kind: box, size: [0.2, 0.1, 0.3]}
      mass: 1
      position: [0, 0, 1]
      angular_velocity: [1, 2, 3]
  connections: {door: {kind: hinge, between: [post, brick], at: [0, 0, 4], axis: [0, 0, 1]}}
  forces:
    - {body: brick, force: [1, 0, 0], frame: body}
    - {body: brick, force: [1, 0, 0]}
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
    shaken:
      shape: {kind: box, size: [1, 1, 0.2]}
      kinematic: true
      motion: [{displacement: [0, 0, 0.01], factor: {kind: sine, frequency: 1}}]
      position: [-9, 0, 1]
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
