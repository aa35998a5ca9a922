"""Forces that statics leaves open are of least norm: unique, symmetric, whatever the solver did."""

from __future__ import annotations

import numpy as np
import pytest
from physics_runs import GRAVITY, Course, run_config

# Impulses that sweeps changed by no more than this share of the largest stay as they are.
CHOSEN = 1e-6
LONG, WIDE = 1.0, 0.6  # of the table [m]
TABLE = """
scene:
  surfaces: {{top: {{friction: {mu}}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: top}}
    table:
      shape: {{kind: box, size: [1.0, 0.6, 0.1]}}
      mass: 10
      position: [0, 0, 0.05]
      surface: top
    load:
      shape: {{kind: box, size: [0.1, 0.1, 0.1]}}
      mass: 40
      position: [{x}, {y}, 0.15]
      surface: top
numerics: {{{numerics}}}
duration: {duration}
"""
PLANK = """
scene:
  surfaces: {wood: {friction: 0.3}}
  bodies:
    left:
      shape: {kind: cylinder, radius: 0.1, length: 0.4}
      kinematic: true
      position: [-0.3, 0, 0.1]
      orientation: [1, 1, 0, 0]
      angular_velocity: [0, 20, 0]
      surface: wood
    right:
      shape: {kind: cylinder, radius: 0.1, length: 0.4}
      kinematic: true
      position: [0.3, 0, 0.1]
      orientation: [1, 1, 0, 0]
      angular_velocity: [0, -20, 0]
      surface: wood
    plank:
      {shape: {kind: box, size: [1.2, 0.3, 0.04]}, mass: 2, position: [0.1, 0, 0.22], surface: wood}
numerics: {}
duration: 0.5
"""
BRICKS = {  # mass [kg], place [m]
    "one": (2, (-0.25, 0.0, 0.05)),
    "two": (2, (0.25, 0.0, 0.05)),
    "three": (2, (0.03, 0.01, 0.15)),
    "four": (9, (0.05, 0.0, 0.25)),
}
BRICK = "{{shape: {{kind: box, size: [0.4, 0.2, 0.1]}}, mass: {}, position: {}, surface: dry}}"
LINES = "\n    ".join(f"{name}: {BRICK.format(m, list(at))}" for name, (m, at) in BRICKS.items())
WALL = f"""
scene:
  surfaces: {{dry: {{friction: 0.6}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: dry}}
    {LINES}
numerics: {{}}
duration: 0.2
"""


def legs(course: Course, body: str, step: int) -> np.ndarray:
    """Return the normal forces on a body by the floor [N], by x, then y, of the contacts."""
    rows = course.contacts_of("floor", body)
    rows = rows[rows["step"] == step]
    assert len(rows) == 4
    return rows["force_n"][np.lexsort((rows["y"], rows["x"].round(6)))]


def table(x: float, y: float, mu: float = 0.0, numerics: str = "", steps: int = 24) -> Course:
    """Return a run of so many steps; with numerics of its own, in the interpreter."""
    text = TABLE.format(x=x, y=y, mu=mu, numerics=numerics, duration=f"{steps}/240")
    (course,) = run_config(text, interpreted=bool(numerics))
    return course


def least_norm(x: float, y: float) -> np.ndarray:
    """Return the forces of legs at the corners under a centre of gravity at x, y [N].

    Three equations, of the sum and of two moments; the least norm lies in the span of their rows,
    so forces are linear in the place of the leg: W/4 (1 + X x_k + Y y_k), x_k, y_k = +-1, with the
    moments X = 2 x / LONG, Y = 2 y / WIDE. Those that pull carry nothing: with one of them the
    other three follow from the equations alone.
    """
    weight, right, back = 50.0 * GRAVITY, 2.0 * x / LONG, 2.0 * y / WIDE
    signs = np.array([(-1, -1), (-1, 1), (1, -1), (1, 1)])
    forces = 0.25 * weight * (1.0 + signs @ (right, back))
    if forces.min() < 0.0:
        kept = np.flatnonzero(forces > 0.0)
        rows = np.vstack([np.ones(4), signs.T])[:, kept]
        forces = np.zeros(4)
        forces[kept] = np.linalg.solve(rows, weight * np.array([1.0, right, back]))
    return forces


@pytest.mark.parametrize("mu", [0.0, 0.5])
@pytest.mark.parametrize(
    ("x", "y"),
    [(0.25, 0.09), (0.0, 0.0), (0.44, 0.24)],
    ids=["44, 103, 142 and 201 N", "quarters", "one leg carries nothing"],
)
def test_four_legs_share_a_load_by_the_least_norm(x: float, y: float, mu: float) -> None:
    expected = least_norm(0.8 * x, 0.8 * y)  # 40 of 50 kg are off the centre
    if (x, y) == (0.25, 0.09):  # to the newton
        assert expected.round().tolist() == [44.0, 103.0, 142.0, 201.0]
    course = table(x, y, mu)
    for step in (1, 2, 24):
        force = legs(course, "table", step)
        assert force == pytest.approx(expected, abs=CHOSEN * expected.max())
        # What no equation asks for is not there: friction of what nothing pushes sideways.
        if mu > 0.0:
            rows = course.contact[course.contact["step"] == step]
            assert np.abs(rows["impulse_t1"]).max() < CHOSEN * rows["impulse_n"].max()


def test_forces_do_not_depend_on_the_order_of_sweeps() -> None:
    orders = ("forward", "backward", "random")
    first, *others = (legs(table(0.25, 0.09, 0.5, f"order: {o}", 1), "table", 1) for o in orders)
    for other in others:
        assert other == pytest.approx(first, abs=CHOSEN * first.max())


def test_what_moves_and_how_well_it_is_solved_stay() -> None:
    """The table stands in both; a solve may end 1e-11 m/s worse, a hundredth of its tolerance."""
    chosen, solved = (
        table(0.25, 0.09, 0.5),
        table(0.25, 0.09, 0.5, "undetermined_forces: as_solved"),
    )
    assert chosen.step["residual"].max() <= solved.step["residual"].max() + 1e-11
    # Poses differ by less than both ends of each step may be off.
    bound = 24 * chosen.dt * 2e-9
    assert np.abs(chosen.pose - solved.pose).max() < bound
    assert np.ptp(legs(solved, "table", 1) - legs(chosen, "table", 1)) > 1.0, "as the solver ends"


def test_a_plank_on_turning_rollers_is_pushed_as_symmetrically_as_it_lies() -> None:
    (course,) = run_config(PLANK)
    for roller in ("left", "right"):
        rows = course.contacts_of(roller, "plank")
        rows = rows[rows["step"] == 1]
        one, other = rows["force_n"]
        assert one == pytest.approx(other, rel=1e-7)
    # Each step may turn it by its residual over half its width, all one way. A plank askew is
    # turned on by its rollers: an e-fold in 0.15 s, less than a hundredfold in half a second.
    wide, steps = 0.15, len(course.step)
    yaw = course.pose[:, course.names.index("plank"), 6]
    assert np.abs(2.0 * yaw).max() < 100.0 * steps * course.dt * 1e-9 / wide


def test_bricks_rest_on_the_impulses_that_an_independent_projection_finds() -> None:
    """Least norm within open cones: impulses lie in the span of J, lambda = J y for some y."""
    (course,) = run_config(WALL)
    step = int(course.step["step"][-1])
    rows = course.contact[course.contact["step"] == step]
    pose = course.pose[step]
    bodies = len(course.names)
    jacobian = np.zeros((len(rows), 3, bodies, 6))
    normal = np.stack([rows[f"n{axis}"] for axis in "xyz"], axis=-1)
    tangent = np.stack([rows[f"t1{axis}"] for axis in "xyz"], axis=-1)
    frame = np.stack([normal, tangent, np.cross(normal, tangent)], axis=1)
    point = np.stack([rows[axis] for axis in "xyz"], axis=-1)
    every = np.arange(len(rows))
    for name, sign in (("body_a", -1.0), ("body_b", 1.0)):
        lever = (point - pose[rows[name], :3])[:, None, :]
        jacobian[every, :, rows[name], :3] = sign * frame
        jacobian[every, :, rows[name], 3:] = sign * np.cross(lever, frame)
    movable = [course.names.index(name) for name in BRICKS]
    matrix = jacobian[:, :, movable].reshape(3 * len(rows), -1)
    impulse = np.stack([rows[f"impulse_{axis}"] for axis in ("n", "t1", "t2")], axis=-1)
    sideways = np.hypot(impulse[:, 1], impulse[:, 2])
    assert (sideways < 0.6 * impulse[:, 0]).all(), "cones were to be open"
    assert np.linalg.matrix_rank(matrix) < len(matrix), "forces were to be undetermined"
    least = matrix @ np.linalg.lstsq(matrix, impulse.ravel())[0]
    # Contacts' levers end on each body's surface, within the penetration of the logged point.
    assert impulse.ravel() == pytest.approx(least, abs=10.0 * CHOSEN * impulse.max())
