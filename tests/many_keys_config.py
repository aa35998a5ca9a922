"""A config with most keys that there are: where tests of random changes begin."""

MANY_KEYS = """\
question: What if?
scene:
  gravity: {magnitude: 9.81, slope: 0.1, azimuth_degrees: 45}
  surfaces:
    rubber: {restitution: 0.8, compliance: 1e-6, friction: 0.3, damping_ratio: 0.1, cohesion: 0.01}
  bodies:
    floor: {shape: {kind: plane, normal: [0, 0, 1], offset: 0.5}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      inertia: [0.1, 0.2, 0.25]
      surface: rubber
      release: {above: floor, clearance: 0.002, phase: 0.2, at: [0.1, 0.2]}
      orientation: {axis: [0, 0, 1], degrees: 30}
      drag: {linear: 0.1, quadratic: 0.2, angular: 0.1}
    block: {shape: {kind: box, size: [1, 1, 1]}, density: 10, position: [5, 0, 1]}
    rock:
      shape: {kind: hull, points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.1, 0.1, 0.1]]}
      density: 10
      release: {above: floor, clearance: 0.5, at: [9, 9]}
    thing:
      shape:
        kind: compound
        parts:
          - {shape: {kind: capsule, radius: 0.1, length: 0.3}, position: [0.1, 0, 0]}
          - {shape: {kind: cylinder, radius: 0.1, length: 0.3}, orientation: [1, 1, 0, 0]}
      mass: 2.0
      position: [7, 0, 1]
    belt:
      shape: {kind: box, size: [1, 1, 1]}
      kinematic: true
      position: [0, 9, 0]
      surface_velocity: [0.1, 0.1, 0]
  arrangements:
    tower:
      {kind: tower, count: 2, base: [4, 4, 0.5], gap: 0.001,
      body: {shape: {kind: box, size: [1, 1, 1]}, mass: 1}}
    heap:
      {kind: grid, counts: [2, 2, 1], spacing: [1, 1, 1], jitter: 0.1, seed: 3, origin: [20, 0, 2],
      body: {shape: {kind: sphere, radius: 0.1}, mass: 1, surface: rubber}}
    pyramid:
      {kind: pyramid, base_count: 2, gap: 0.1, base: [40, 0, 0.5],
      body: {shape: {kind: capsule, radius: 0.1, length: 0.4}, mass: 1}}
  springs:
    - {a: ball, b: block, stiffness: 10, damping: 0.1, rest_length: 0.5, point_a: [0.1, 0, 0]}
  forces:
    - {body: tower_2, from: 0.01, to: 0.02, force: [0.1, 0, 1], torque: [1, 0, 0.1]}
events:
  - {at: 0.02, body: ball, scale_mass: 1.05, contact_cache: keep}
  - {at: 0.03, body: belt, velocity: [1, 0, 0.1], angular_velocity: [0, 0.1, 1]}
  - {at: 0.03, body: thing, teleport: [7, 1, 1]}
numerics:
  {timestep: 1/240, sweeps: 20, over_relaxation: 1.1, tolerance: 1e-9, stabilisation_gain: 0.02,
  slop: 0.001, projection: 0.2, projection_sweeps: 22, restitution_threshold: 2,
  cache_distance: 0.02, cache_normal_cosine: 0.95, sleeping: true, sleep_speed: 0.005,
  sleep_time: 0.5}
duration: 1/24
record: {residuals: {from: 0.01, to: 0.02}, contacts: {from: 0.001, to: 0.04}}
always:
  {energy: none, penetration: none, impulses: none, momentum: none, residual: 1, speed: 1e9,
  stop: false}
measure:
  aside: {kind: displacement, body: block, from: 0.001, to: 0.02, along: [1, 0.1, 0]}
  energy: {kind: energy_drift}
expect:
  - {name: aside, measure: aside, equals: {value: 0, absolute: 1e-9}}
"""
