"""Anisotropic friction: paths and thresholds in closed form, and the law that every step keeps.

    F = mu M:   lambda_t = -n F^2 v / |F v| where it slides, |F^-1 lambda_t| <= n where it sticks
Kernels run in the interpreter: a step of a block takes some 20 ms, and nothing is compiled.
"""

from __future__ import annotations

from math import asinh, atan, cos, pi, sin, sqrt
from typing import Any

import numpy as np
import pytest
from interpreted import interpreted
from interpreted_steps import interpreted_bench
from laboratory import EVERYTHING, Bench, box, plane, planned, resolved, sphere

from lavendersim.engine.effects import anisotropic_friction, keys
from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

G = 9.81
MU = 0.3
SHARP = {"solver": "adaptive", "sweeps": 400, "tolerance": 1e-13}
LEFT = 1e-13  # [m/s] at which sweeps stop
ROUND_OFF = 1.1e-16
SIZE = (0.4, 0.4, 0.1)


def direction(angle: float) -> tuple[float, float, float]:
    return cos(angle), sin(angle), 0.0


def block(q: float, grain: float, slope: float = 0.0, of: str = "block", **given: Any) -> Bench:
    """A block on a floor, one of which has a grain, under gravity that leans to x by a tangent."""
    numerics = {**SHARP, **given.pop("numerics", {})}
    wood = {"friction": MU, "across_grain": q, "grain": direction(grain)}
    own, other = (wood, {"friction": MU}) if of == "block" else ({"friction": MU}, wood)
    bodies = {
        "floor": plane(**other),
        "block": box(SIZE, (0.0, 0.0, 0.05), **own, **given),
    }
    lean = atan(slope)
    cell = resolved(bodies, (G * sin(lean), 0.0, -G * cos(lean)), **numerics)
    return interpreted_bench(cell, planned(cell).spec)


def of_grain(q: float, angle: float) -> np.ndarray:
    e = np.array([cos(angle), sin(angle)])
    return q * np.eye(2) + (1.0 - q) * np.outer(e, e)


def in_the_plane(rows: np.ndarray, name: str) -> np.ndarray:
    """Return a logged tangential vector of contacts on a floor, world x and y (n, 2)."""
    first = np.stack([rows["t1x"], rows["t1y"]], axis=-1)
    second = np.stack([-rows["t1y"], rows["t1x"]], axis=-1) * rows["nz"][:, None]
    return rows[f"{name}_t1"][:, None] * first + rows[f"{name}_t2"][:, None] * second


def kernels() -> list[Any]:
    spec = EVERYTHING
    makers = ("make_section", "make_mean", "make_axes")
    return [interpreted(getattr(anisotropic_friction, name)(spec)) for name in makers]


@pytest.mark.parametrize("q", [0.05, 0.5, 1.0, 3.0, 40.0])
@pytest.mark.parametrize("turn", [0.0, 0.3, 0.25 * pi, 1.2, 0.5 * pi])
def test_mean_and_axes_of_two_grains(q: float, turn: float) -> None:
    """X = A # B is the one positive solution of X A^-1 X = B; its axes are its eigenvectors."""
    section, mean, axes = kernels()

    def matrix(m: Any) -> np.ndarray:
        return np.array([[m[0], m[1]], [m[1], m[2]]])

    one, other = section(cos(0.2), sin(0.2), q), section(cos(0.2 + turn), sin(0.2 + turn), q)
    np.testing.assert_allclose(matrix(one), of_grain(q, 0.2), rtol=1e-14, atol=1e-14 * q)
    x = mean(one, other)
    most = max(q, 1.0 / q)
    # Conditions of A and of X, each at most `most`, times roundings of entries up to q.
    missed = matrix(x) @ np.linalg.inv(matrix(one)) @ matrix(x) - matrix(other)
    np.testing.assert_allclose(missed, 0.0, atol=50 * ROUND_OFF * most * most * max(q, 1.0))
    more, less, c, s = axes(*x)
    turned = np.array([[c, -s], [s, c]])
    assert more >= less > 0.0
    np.testing.assert_allclose(
        turned @ np.diag([more, less]) @ turned.T, matrix(x), atol=20 * ROUND_OFF * more
    )


def test_pairs_take_the_mean_of_ratios_above_zero() -> None:
    assert keys.mean_above_zero(2.0, 8.0) == keys.mean_above_zero(8.0, 2.0) == 4.0
    assert keys.mean_above_zero(2.0, 0.0) == keys.mean_above_zero(0.0, 2.0) == 2.0
    assert keys.mean_above_zero(0.0, 0.0) == 0.0


@pytest.mark.parametrize("of", ["block", "floor"])
def test_what_slides_keeps_maximum_dissipation(of: str) -> None:
    """Of the forces of the ellipse the one that takes most: its form for a given slip is closed."""
    rows = block(2.5, 0.4, of=of, velocity=(1.0, 0.5, 0.0)).run(4).contact
    f = MU * of_grain(2.5, 0.4)
    slip, impulse = in_the_plane(rows, "slip"), in_the_plane(rows, "impulse")
    stretched = slip @ f
    expected = -rows["impulse_n"][:, None] * (stretched @ f)
    expected /= np.linalg.norm(stretched, axis=1)[:, None]
    assert len(rows) >= 16
    # What sweeps leave of the slip turns the force by LEFT / |slip|.
    np.testing.assert_allclose(impulse, expected, rtol=1e-10, atol=1e-14)
    along = np.linalg.norm(impulse, axis=1)
    np.testing.assert_allclose(rows["friction"], along / rows["impulse_n"], rtol=1e-10)
    # The matrix in the log is that of the ellipse, in the log's own tangents.
    t = np.stack([rows["t1x"], rows["t1y"]], axis=-1)
    quadratic = np.einsum("ni,ij,nj->n", t, f, t)
    np.testing.assert_allclose(rows["friction_11"], quadratic, rtol=20 * ROUND_OFF)
    determinant = rows["friction_11"] * rows["friction_22"] - rows["friction_12"] ** 2
    np.testing.assert_allclose(determinant, np.linalg.det(f), rtol=40 * ROUND_OFF)


def missed_curve(rate: int) -> float:
    """Return by how much v_y / v_y0 misses (v_x / v_x0)^(q^2) after 0.1 s."""
    bench = block(sqrt(2.0), 0.0, velocity=(1.0, 1.0, 0.0), numerics={"timestep": f"1/{rate}"})
    bench.run(rate // 10)
    v = bench.velocity[1]
    return float(v[1] - v[0] ** 2)


def test_a_path_curves_by_its_invariant_to_first_order() -> None:
    """v_i' = -g mu_i^2 v_i / |F v|, so d ln v_y / d ln v_x = q^2, whatever the speed."""
    coarse, fine = missed_curve(120), missed_curve(240)
    # The step is Euler's backwards: its error halves, but for its square.
    assert abs(fine) < 0.01
    assert coarse / fine == pytest.approx(2.0, rel=0.05)


def test_the_way_to_a_stop_in_closed_form_is_its_integral() -> None:
    """What configs/effects/anisotropic_friction.yaml expects, by Simpson's rule."""
    u = np.linspace(0.0, 1.0, 4001)
    root = np.sqrt(1.0 + 2.0 * u * u)

    def simpson(f: np.ndarray) -> float:
        total = f[0] + f[-1] + 4.0 * f[1::2].sum() + 2.0 * f[2:-1:2].sum()
        return float(total) / 12000.0

    along, across = (
        (3.0**1.5 - 1.0) / 6.0,
        5.0 * sqrt(3.0) / 16.0 - asinh(sqrt(2.0)) / 16.0 / sqrt(2.0),
    )
    assert simpson(u * root) == pytest.approx(along, rel=1e-11)
    assert simpson(u * u * root) == pytest.approx(across, rel=1e-11)
    assert (along / (G * MU), across / (G * MU)) == pytest.approx(
        (0.23763464, 0.16670398), abs=1e-8
    )


@pytest.mark.parametrize("angle", [0.0, 0.25 * pi, 1.2, 0.5 * pi])
def test_a_block_sticks_up_to_the_ellipse(angle: float) -> None:
    """F^-1 d has length 1 / tan of the slope at which d, its direction, no longer sticks."""
    q = 2.0
    limit = 1.0 / sqrt((cos(angle) / MU) ** 2 + (sin(angle) / (q * MU)) ** 2)
    sticks = block(q, angle, slope=0.999 * limit)
    sticks.run(6)
    np.testing.assert_allclose(sticks.velocity[1], 0.0, atol=6 * LEFT)
    slides = block(q, angle, slope=1.01 * limit)
    slides.run(6)
    # At the limit itself it moves along the ellipse's normal where d is, F^-2 d.
    normal = np.linalg.inv(MU * of_grain(q, angle)) @ np.linalg.inv(MU * of_grain(q, angle))
    way = normal[:, 0] / np.linalg.norm(normal[:, 0])
    v = slides.velocity[1][:2]
    # The force must give way by 1 %: the angle of v by some per cent of the ratio's square.
    assert float(v @ way) > 0.99 * float(np.linalg.norm(v)) > 0.0


@pytest.mark.parametrize(
    "numerics",
    [
        {"solver": "projected_gauss_seidel"},
        {"solver": "jacobi", "sweeps": 3000},
        {"solver": "accelerated_projected_gradient", "sweeps": 3000},
        {"solver": "nonsmooth_conjugate_gradient", "sweeps": 3000},
    ],
    ids=lambda one: one["solver"],
)
def test_every_solver_finds_the_same_motion(numerics: dict[str, Any]) -> None:
    """Newton's method is beside the sweeps of the exact one; packed sweeps have no interpreter."""
    given = {"velocity": (0.02, 0.05, 0.0), "mass": 2.0}
    found = block(3.0, 0.7, slope=0.5, numerics={**numerics, "tolerance": 1e-10}, **given)
    exact = block(3.0, 0.7, slope=0.5, **given)
    found.run(2)
    exact.run(2)
    # Each step is solved to 1e-10 m/s by contact; four of them share a block.
    np.testing.assert_allclose(found.velocity[1], exact.velocity[1], atol=4e-9)


def test_what_rests_begins_each_step_with_its_impulse() -> None:
    """A cached impulse in world axes is the same along stretched tangents: nothing is left."""
    rows = block(3.0, 0.4, slope=0.25).run(4)
    first, *later = rows.step["sweeps"][1:].tolist()
    assert first > 0
    assert max(later) <= 1


def test_of_two_grains_each_counts_half_and_end_grain_is_across() -> None:
    def matrix(a: Any, b: Any) -> tuple[float, float, float]:
        wood = {"friction": MU, "across_grain": 4.0}
        bodies = {
            "floor": plane(**wood, grain=a),
            "ball": sphere(0.1, (0.0, 0.0, 0.1), **wood, grain=b),
        }
        cell = resolved(bodies, (0.0, 0.0, -G), **SHARP)
        rows = interpreted_bench(cell, planned(cell).spec).run(1).contact
        row = rows[0]
        t = np.array([[row["t1x"], row["t1y"]], [-row["t1y"] * row["nz"], row["t1x"] * row["nz"]]])
        f = np.array(
            [[row["friction_11"], row["friction_12"]], [row["friction_12"], row["friction_22"]]]
        )
        turned = t.T @ f @ t
        return turned[0, 0], turned[0, 1], turned[1, 1]

    x, y, up = (2.0, 0.0, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, 1.0)
    none = (0.0, 0.0, 0.0)
    cases = [
        ((x, none), (MU, 0.0, 4.0 * MU)),
        ((none, x), (MU, 0.0, 4.0 * MU)),
        ((x, x), (MU, 0.0, 4.0 * MU)),
        ((x, y), (2.0 * MU, 0.0, 2.0 * MU)),
        ((up, none), (4.0 * MU, 0.0, 4.0 * MU)),
    ]
    for grains, expected in cases:
        np.testing.assert_allclose(matrix(*grains), expected, rtol=1e-14, atol=1e-15)


def test_stribecks_velocity_is_that_of_the_slip_itself() -> None:
    """mu(v) with v = |slip|, not stretched: the short and the long axis times the same."""
    surface = {"static_friction": 0.6, "stribeck_velocity": 0.5}
    wood = {"friction": MU, "across_grain": 3.0, "grain": (1.0, 0.0, 0.0), **surface}
    bodies = {
        "floor": plane(**wood),
        "block": box(SIZE, (0.0, 0.0, 0.05), velocity=(0.3, 0.4, 0.0), friction=MU, **surface),
    }
    cell = resolved(bodies, (0.0, 0.0, -G), **SHARP)
    rows = interpreted_bench(cell, planned(cell).spec).run(1).contact
    mu = MU + (0.6 - MU) / (1.0 + 0.25 / 0.25)
    determinant = rows["friction_11"] * rows["friction_22"] - rows["friction_12"] ** 2
    np.testing.assert_allclose(determinant, 3.0 * mu * mu, rtol=40 * ROUND_OFF)


def test_without_a_grain_or_a_ratio_the_effect_is_absent() -> None:
    plain = {
        "floor": plane(friction=MU, across_grain=2.0),
        "b": box(SIZE, (0, 0, 0.05), friction=MU),
    }
    assert "anisotropic_friction" not in planned(resolved(plain, (0.0, 0.0, -G))).spec.effects
    plain["floor"] = plane(friction=MU, grain=(1.0, 0.0, 0.0))
    assert "anisotropic_friction" not in planned(resolved(plain, (0.0, 0.0, -G))).spec.effects


REFUSED = """
scene:
  surfaces: {{wood: {{friction: 0.3{surface}}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: wood{grain}}}
    ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, position: [0, 0, 0.1], surface: wood}}
numerics: {{timestep: 1/240{numerics}}}
duration: 1
"""


@pytest.mark.parametrize(
    ("surface", "grain", "numerics", "at", "words"),
    [
        ("", ", grain: [1, 0, 0]", "", "5:", "expected across_grain"),
        (", across_grain: 2", "", "", "3:", "no body has a grain"),
        (", across_grain: 2, rolling_friction: 0.1", ", grain: [1, 0, 0]", "", "3:", "expected 0"),
        (", across_grain: 2", ", grain: [1, 0, 0]", ", friction_cone: pyramid", "7:", "disc"),
    ],
)
def test_what_it_cannot_be_with_is_refused_where_it_stands(
    surface: str, grain: str, numerics: str, at: str, words: str
) -> None:
    text = REFUSED.format(surface=surface, grain=grain, numerics=numerics)
    with pytest.raises(ConfigError, match=f"{at}.*{words}"):
        load_experiment_text(text, "grain.yaml").cells()
