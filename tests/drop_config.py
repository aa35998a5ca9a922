"""The smallest experiment there is: a ball from 0.1 m at e = 0.5, ideal apex 0.025 m.

Its scene at the chapter's numerics, also from half the height, is what other configs begin with.
"""

SCENE = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      surface: {restitution: 0.5}
      release: {above: floor, clearance: 0.1}
numerics: chapter
"""
LOW = SCENE.replace("clearance: 0.1", "clearance: 0.05")
# Six cells of one plan: worlds.
SIX = f"""\
{SCENE}duration: 1.0
sweep:
  mass: {{path: scene.bodies.ball.mass, values: [0.5, 1, 3]}}
  e: {{path: scene.bodies.ball.surface.restitution, values: [0.3, 0.8]}}
"""
DROP = f"""\
question: How high?
expected: e^2 h.
{SCENE}duration: 0.5
measure:
  rebound: {{kind: first_apex, body: ball, above: floor}}
expect:
  - {{name: rebound, measure: rebound, between: [0.02, 0.03]}}
"""
