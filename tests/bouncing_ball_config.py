"""A ball that bounces on a plane from three phases of a step: the scene of tests of costs."""

from __future__ import annotations

BOUNCING_BALL = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      surface: {restitution: 0.8}
      release: {above: floor, clearance: 0.2}
numerics: {preset: chapter, slop: 0.002}
duration: 0.6
sweep:
  phase: {path: scene.bodies.ball.release.phase, values: [0, 1/3, 2/3]}
measure:
  apex: {kind: apex_error, body: ball, above: floor}
"""
