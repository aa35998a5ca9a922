"""A ball on a floor with all kinds of measures and closed forms: numbers of any size go to them."""

MANY_MEASURES = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      inertia: [0.003, 0.004, 0.005]
      surface: {restitution: 0.5, compliance: 1e-6}
      release: {above: floor, clearance: 0.001}
      velocity: [0, 0, -0.1]
      angular_velocity: [0.01, 5, 0.01]
  gravity: 9.81
numerics: {timestep: 1/240, stabilisation_gain: 0.02, slop: 0.001, projection: 0.2, tolerance: 1e-9}
duration: 1/24
record: {residuals: all, velocities: true}
measure:
  apex:
    kind: first_apex
    body: ball
    above: floor
    over: {form: rebound_height, bodies: [ball, floor]}
  hit: {kind: impact_impulse, body: ball, against: {form: newton_impulse, bodies: [floor, ball]}}
  dropped: {kind: impact_impulse, body: ball, over: {form: drop_impulse, bodies: [ball, floor]}}
  pushed: {kind: step_impulse, body: ball, step: 3, over: {form: weight, bodies: [ball]}}
  before: {kind: approach_velocity, body: ball, over: {form: impact_speed, bodies: [ball, floor]}}
  after:
    kind: separation_velocity
    body: ball
    against: {form: newton_separation_velocity, bodies: [floor, ball]}
  inverse:
    kind: inverse_effective_mass
    body: ball
    against: {form: inverse_effective_mass, bodies: [floor, ball]}
  peak: {kind: peak_force, body: ball, over: {form: release_height, bodies: [ball, floor]}}
  strong: {kind: steps_above_force, body: ball, threshold: 1}
  balance: {kind: impulse_balance}
  whole: {kind: impulse_balance, window: all}
  momentum: {kind: momentum_drift}
  force: {kind: steady_force, body: ball, last: 0.02}
  torque: {kind: steady_torque, body: ball, along: [1, 0, 1], last: 0.02}
  centre: {kind: centre_of_mass, along: [1, 0, 1], from: 0.01, to: 0.02}
  depth:
    kind: steady_penetration
    body: ball
    last: 0.02
    above_slop: true
    against: {form: steady_penetration_above_slop, bodies: [ball, floor]}
  deepest: {kind: max_penetration, body: ball, over: {form: slop}}
  settled: {kind: settling_time, body: ball, threshold: 0.001}
  lasts: {kind: simulated_duration}
  bounces: {kind: energy_by_bounce, body: ball, above: floor, bounces: 2}
  bounced: {kind: energy_after_bounces, body: ball, above: floor, bounces: 2}
  carried: {kind: force_error, last: 0.02}
  drifts: {kind: energy_drift}
  gains: {kind: energy_gain, body: ball, above: floor}
  turning: {kind: angular_momentum_drift}
  natural: {kind: law_violation, part: natural_map}
  hard: {kind: not_converged_steps}
  sweeps: {kind: residual_by_sweep, after: 0.01}
  residual: {kind: final_residual, after: 0.01}
  optimal: {kind: optimality}
  deep: {kind: overlap, last: 0.02}
  apex_error: {kind: apex_error, body: ball, above: floor}
  drift: {kind: drift, after: 0.01}
  slip: {kind: slip_distance, body: ball, last: 0.01}
  creep: {kind: creep, body: ball, last: 0.01}
  friction: {kind: effective_friction, body: ball, on: floor, last: 0.01}
  through: {kind: passed_through, body: ball, wall: floor}
  aside: {kind: displacement, body: ball, from: 0.001, to: 0.02, along: [1, 0.1, 0]}
  mean: {kind: mean_velocity, body: ball, along: [1, 0.1, 0]}
  turns: {kind: mean_angular_velocity, body: ball, along: [1, 0.1, 0]}
  fast: {kind: top_speed}
  rest: {kind: rest_time, slower_than: 0.01}
  tilt: {kind: tilt, body: ball, axis: [1, 0, 1]}
  place: {kind: position, body: ball, along: [1, 0, 1], time: 0.01}
  speed: {kind: velocity, body: ball, along: [1, 0, 1], time: 0.01}
  spin: {kind: angular_velocity, body: ball, along: [1, 0, 1], time: 0.01}
  passes: {kind: first_passage, body: ball, along: [1, 0, 1], level: 0.1, crossing: either}
  fallen: {kind: fallen_bodies, degrees: 30}
  energy: {kind: energy, part: mechanical, time: 0.01}
  lost: {kind: energy, part: kinetic, time: 0.02, since: 0.01}
  impact: {kind: velocity_error, body: ball, other: floor}
  omega: {kind: angular_velocity_error, body: ball, until: 0.03}
  flips: {kind: flip_time_error, body: ball, flips: 2}
  share: {kind: ratio, measure: hit, to: pushed}
  less: {kind: difference, measure: hit, minus: pushed}
  root: {kind: power, measure: hit, exponent: 1/2}
  middle: {kind: of_row, measure: sweeps, of: mean}
expect:
  - {name: high, measure: apex, at_least: 0.1}
  - {name: near, measure: energy, equals: {value: 1, relative: 0.1, absolute: 0.1}}
"""
