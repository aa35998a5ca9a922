"""A tippe top, sliding: Jellett's integral stays to order 2 whatever friction does; it turns over.

J = -L . s, with L the angular momentum about the centre of mass and s from there to the contact.
s = a e - R z of a sphere whose centre is a along the axis e, so that ds/dt = a w x e; L = A (w -
w_e e) + C w_e e is across that, and dL/dt = s x F is across s, for any F.
"""

from __future__ import annotations

import numpy as np
import pytest
from shared_runs import GRAVITY, States, orders, run_scenes

RADIUS, BALLAST, HALF = 0.03, 0.026, 0.01  # [m]; the ballast's half height, and how low it lies
MASS, SPIN, TILT = 0.05, 200.0, 10.0  # [kg], [rad/s], [degree]
RATES, DURATION = (1000, 2000, 4000), 0.5  # steps a second, [s]
SHARE = BALLAST**2 * HALF / (RADIUS**3 + BALLAST**2 * HALF)
OFF = SHARE * HALF  # a: of the centre of mass below that of the sphere [m]
AXIAL = MASS * 0.4 * ((1.0 - SHARE) * RADIUS**2 + SHARE * BALLAST**2)
ACROSS = MASS * (
    (1.0 - SHARE) * (0.4 * RADIUS**2 + OFF**2)
    + SHARE * ((BALLAST**2 + HALF**2) / 5.0 + (HALF - OFF) ** 2)
)


def scene(rate: int, friction: float) -> str:
    sphere = f"{{shape: {{kind: sphere, radius: {RADIUS}}}}}"
    flat = f"{{kind: ellipsoid, semi_axes: [{BALLAST}, {BALLAST}, {HALF}]}}"
    return f"""
scene:
  surfaces: {{smooth: {{friction: {friction}}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: smooth}}
    top:
      shape: {{kind: compound, parts: [{sphere}, {{shape: {flat}, position: [0, 0, -{HALF}]}}]}}
      mass: {MASS}
      surface: smooth
      release: {{above: floor, clearance: 0}}
      orientation: {{axis: [0, 1, 0], degrees: {TILT}}}
      angular_velocity: [0, 0, {SPIN}]
numerics: {{timestep: 1/{rate}}}
duration: {DURATION}
"""


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    scenes = {f"at {rate}": scene(rate, 0.1) for rate in RATES}
    return run_scenes(scenes | {"frictional": scene(RATES[-1], 0.15)})


def axis(states: States) -> np.ndarray:
    """Return e by time: of its own frame, whose z the ballast lies on."""
    w, x, y, z = states.turn[:, states.names.index("top")].T
    return np.stack([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)], 1)


def jellett(states: States) -> np.ndarray:
    e, spin = axis(states), states.of("top")[2]
    along = (spin * e).sum(1)[:, None] * e
    momentum = ACROSS * (spin - along) + AXIAL * along
    return -(momentum * (OFF * e - [0.0, 0.0, RADIUS])).sum(1)


def test_jellett_s_integral_stays_to_order_2(ran: dict[str, States]) -> None:
    errors = []
    for rate in RATES:
        values = jellett(ran[f"at {rate}"])
        errors.append(float(abs(values / values[0] - 1.0).max()))
    # At least: a series in (W dt)^2, 0.04 at the coarsest, less 0.04 of the first ratio.
    assert min(orders(errors)) >= 1.9
    assert errors[-1] < (SPIN / RATES[-1]) ** 2 / 12.0


def test_other_friction_leaves_it_as_well(ran: dict[str, States]) -> None:
    values = jellett(ran["frictional"])
    assert abs(values / values[0] - 1.0).max() < (SPIN / RATES[-1]) ** 2 / 12.0


def test_friction_turns_it_over_and_pays_with_spin(ran: dict[str, States]) -> None:
    """Sliding, it leaves the upright; its energy falls, and its centre rises."""
    states = ran[f"at {RATES[-1]}"]
    leaning = axis(states)[:, 2]
    # A torque mu m g R across the spin turns it by some mu m g R t/(C w0) = 0.2 rad in 0.5 s.
    assert np.degrees(np.arccos(leaning[-1])) > TILT + 5.0
    height = states.of("top")[0][:, 2]
    # The sphere rests on the floor but for the slop, 1e-7 m, and what it meets it by in a step.
    np.testing.assert_allclose(height, RADIUS - OFF * leaning, atol=1e-6)
    energy = states.energy()
    assert energy[-1] < energy[0]
    assert energy.max() - energy[0] <= 1e-6 * MASS * GRAVITY * RADIUS
