"""How fast the ends of joints part is known of every row, as the step begins."""

from __future__ import annotations

import numpy as np
from interpreted_steps import interpreted_advance

from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of

TEXT = """
scene:
  gravity: [0, 0, 0]
  bodies:
    hook: {shape: {kind: sphere, radius: 0.01}, fixed: true, position: [0, 0, 0]}
    one: {shape: {kind: box, size: [0.2, 0.3, 0.4]}, mass: 1, position: [0.5, 0.1, -0.2],
          velocity: [1, -2, 3], angular_velocity: [0.3, 0.5, -0.7]}
    two: {shape: {kind: box, size: [0.2, 0.3, 0.4]}, mass: 2, position: [1.0, 0.3, 0.1],
          velocity: [-1, 1, 2], angular_velocity: [-0.4, 0.2, 0.9]}
  connections:
    first: {kind: ball, between: [hook, one], at: [0.1, 0, 0]}
    second: {kind: ball, between: [one, two], at: [0.8, 0.2, 0]}
numerics: {timestep: 1/100, integrator: midpoint_contact}
duration: 1
"""


JOINTS = {"first": (0, 1, (0.1, 0.0, 0.0)), "second": (1, 2, (0.8, 0.2, 0.0))}


def vectors(rows: np.ndarray, prefix: str = "") -> np.ndarray:
    return np.column_stack([rows[f"{prefix}{axis}"] for axis in "xyz"])


def test_ends_part_at_the_velocity_of_one_from_the_other() -> None:
    """v_B + w_B x r_B - v_A - w_A x r_A, of three rows each."""
    config = load_experiment_text(TEXT, "joints.yaml").cells()[0].config
    spec = plan_of(config).spec
    engine = build(config, spec).engine(spec)
    places = vectors(engine.bodies)
    v, w = vectors(engine.velocities, "v"), vectors(engine.velocities, "w")
    engine._entry = interpreted_advance(spec)
    engine.advance(1)
    for k, (a, b, at) in enumerate(JOINTS.values()):
        ends = [v[i] + np.cross(w[i], at - places[i]) for i in (a, b)]
        rows = engine.state.contacts[3 * k : 3 * k + 3]
        assert set(zip(rows["a"].tolist(), rows["b"].tolist(), strict=True)) == {(a, b)}
        found = vectors(rows, "parting_")
        # Arms are turned by what orientations have of round-off.
        np.testing.assert_allclose(found, [ends[1] - ends[0]] * 3, atol=1e-14)
