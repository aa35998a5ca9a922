"""A pair of surfaces is as good as two surfaces that mix to it: the same run, bit for bit."""

from __future__ import annotations

from physics_runs import run_config

# Friction, bounces and springs of contacts between a block, balls and a floor.
SCENE = """\
scene:
  gravity: {magnitude: 9.81, slope: 0.1}
  surfaces: %s
  bodies:
    floor: {shape: {kind: plane}, surface: ground}
    block:
      shape: {kind: box, size: [0.4, 0.3, 0.2]}
      mass: 1
      position: [0, 0, 0.1]
      surface: load
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 0.5], surface: load}
    other: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [1, 0, 0.3], surface: load}
numerics: {timestep: 1/240}
duration: 0.5
"""
# The mean of 0.25 and 0.25, the larger of 0.5 and 0, and 1e-6 + 1e-6 are exact.
MIXED = """{
    ground: {friction: 0.25, restitution: 0.5, compliance: 1e-6},
    load: {friction: 0.25, restitution: 0.5, compliance: 1e-6}}"""
PAIRED = """{
    ground: {friction: 0.9, restitution: 1.0},
    load: {friction: 0.1, compliance: 1e-6}}
  surface_pairs:
    down: {between: [ground, load], friction: 0.25, restitution: 0.5, compliance: 2e-6}
    alike: {between: [load, load], friction: 0.25, restitution: 0.5, compliance: 2e-6}"""


def test_a_run_with_pairs_is_that_of_surfaces_that_mix_to_the_same() -> None:
    (mixed,) = run_config(SCENE % MIXED)
    (paired,) = run_config(SCENE % PAIRED)
    assert len(paired.contact) > 100
    for one, other in ((paired.step, mixed.step), (paired.contact, mixed.contact)):
        assert one.tobytes() == other.tobytes()


def test_without_them_the_same_surfaces_run_otherwise() -> None:
    (paired,) = run_config(SCENE % PAIRED)
    (alone,) = run_config(SCENE % PAIRED.partition("\n  surface_pairs")[0])
    assert paired.step["state_hash"][-1] != alone.step["state_hash"][-1]
