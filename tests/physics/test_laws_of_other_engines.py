"""Laws of whole runs by other engines: closed forms, one schema, equal bytes, reported ends."""

from __future__ import annotations

from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest

from lavendersim.errors import NotReportedError
from lavendersim.peers.catalogue import PEERS, installed_version, peer_of
from tests.engines import BALL, BOX, log_of, needs, run_by


def every(name: str, *values: object) -> object:
    """Return a case of an engine's variant, skipped where the engine is not installed."""
    return pytest.param(name, *values, marks=needs(peer_of(name).name))


G, H = 9.81, 0.01  # gravity [m/s^2], timestep of BALL [s]


EULER = 0.5 * G * H * 0.5
SINGLE = 1e-5  # 50 sums of numbers of 3 m with 24 bits: 50 * 1.8e-7


@pytest.mark.parametrize(
    ("engine", "error", "rounding"),
    [
        every("mujoco", EULER, 2e-14),  # 50 sums of numbers of 3 m: 50 * 4e-16
        every("mujoco-rk4", 0.0, 2e-14),
        every("bullet", EULER, 2e-14),
        every("bullet-accurate", EULER, 2e-14),
        every("physx", EULER, SINGLE),
        every("dart", EULER, 2e-14),
        every("drake", EULER, 2e-14),
        every("rapier", EULER / 4, SINGLE),  # each of its 4 iterations is a small step
        every("rapier-stiff", EULER / 8, SINGLE),
    ],
)
def test_a_ball_in_flight_is_off_by_what_its_integrator_leaves(
    engine: str, error: float, rounding: float, tmp_path: Path
) -> None:
    """Semi-implicit Euler: sum of v_k h = v t - g t (t + h)/2, g h t/2 too low; order 4: exact."""
    log = log_of(run_by(BALL, engine, tmp_path))
    t = log.step["time"]
    height = 3.0 + 2.0 * t - 0.5 * G * t * t
    off = height - log.pose[:, 0, 2]
    assert off[-1] == pytest.approx(error, abs=rounding)
    np.testing.assert_allclose(log.pose[:, 0, 0], t, atol=rounding)
    np.testing.assert_allclose(log.velocity[:, 0, 3:], [[0.0, 3.0, 0.0]] * 51, atol=20 * rounding)


@needs("rapier")
def test_rapier_slides_as_coulomb_says(tmp_path: Path) -> None:
    """The same law, by its own solver in single precision: contacts settle within some steps, in
    which the box turns and falls by its allowed error of 5 mm at the most: 1e-3 of 1 m/s.
    """
    log = log_of(run_by(BOX, "rapier", tmp_path))
    given = G * cos(pi / 6) * 0.5 + log.velocity[-1, 1, 2]
    assert log.velocity[-1, 1, 0] == pytest.approx(G * sin(pi / 6) * 0.5 - 0.3 * given, abs=1e-3)


@needs("mujoco")
def test_a_box_slides_down_a_slope_as_coulomb_says(tmp_path: Path) -> None:
    """At 30 degrees and mu 0.3 every impulse is on the cone: with J = m (g cos t + v_n), what its
    contacts gave, v_t = g sin t - mu J / m. Its friction is regularised by the share 1e-4 of what
    the impedance 0.9999 leaves, of speeds of 1 m/s.
    """
    log = log_of(run_by(BOX, "mujoco-stiff", tmp_path))
    given = G * cos(pi / 6) * 0.5 + log.velocity[-1, 1, 2]
    expected = G * sin(pi / 6) * 0.5 - 0.3 * given
    assert log.velocity[-1, 1, 0] == pytest.approx(expected, abs=1e-4)
    assert log.contact["impulse_n"].sum() / 2.0 == pytest.approx(given, rel=1e-9)
    assert np.all(log.contact["friction"] == 0.3)


@needs("mujoco")
def test_reported_impulses_are_all_that_changes_momentum(tmp_path: Path) -> None:
    """p' - p = M g h + J, with every sign and axis of J: to round-off of 2 N s in most steps.

    Where its Newton's method stops before that (impacts), it leaves 1e-5 N s of some 0.3; a wrong
    sign of one tangent is 0.1 N s.
    """
    across = BOX.replace("mass: 2,", "mass: 2, velocity: [0, 0.5, 0],")  # along both tangents
    log = log_of(run_by(across, "mujoco-stiff", tmp_path))
    n, t1 = ([log.contact[f"{v}{axis}"] for axis in "xyz"] for v in ("n", "t1"))
    t2 = np.cross(np.array(n).T, np.array(t1).T).T
    push = [
        log.contact["impulse_n"] * a + log.contact["impulse_t1"] * b + log.contact["impulse_t2"] * c
        for a, b, c in zip(n, t1, t2, strict=True)
    ]
    momentum = np.array([log.step[f"momentum_{axis}"] for axis in "xyz"]).T
    total = np.array([np.bincount(log.contact["step"], one, len(momentum)) for one in push]).T
    weight = 2.0 * np.array([4.905, 0.0, -8.495709211125343]) / 240
    # the floor is body 0, A: impulses are on the box
    left = np.abs(np.diff(momentum, axis=0) - weight - total[1:]).max(axis=1)
    assert np.median(left) < 1e-14
    assert left.max() < 1e-4


@needs("mujoco")
def test_a_log_has_the_columns_of_ours_and_reasons_for_the_others(tmp_path: Path) -> None:
    log = log_of(run_by(BOX, "mujoco", tmp_path, "engines: {mujoco: {iterations: 50}}"))
    assert len(log.step) == 121
    assert log.pose.shape == (121, 2, 7)
    assert log.velocity.shape == (121, 2, 6)
    made_by = log.metadata["engine"]
    assert (made_by["name"], made_by["settings"]) == ("mujoco", "iterations: 50")
    assert made_by["version"] == f"MuJoCo {installed_version('mujoco')}"
    assert made_by["law"] == PEERS["mujoco"].law
    with pytest.raises(NotReportedError, match=r"no /step\.residual: MuJoCo does not report it"):
        log.step["residual"]
    with pytest.raises(NotReportedError, match=r"no /contacts\.approach_velocity: MuJoCo"):
        log.contact["approach_velocity"]


@pytest.mark.parametrize("engine", [every(name) for name in PEERS])
def test_two_runs_are_the_same_bytes(engine: str, tmp_path: Path) -> None:
    logs = [
        run_by(BOX, engine, tmp_path / name).run.cells[0].path.read_bytes() for name in ("a", "b")
    ]
    assert logs[0] == logs[1]


@needs("mujoco")
def test_what_it_does_not_tell_is_not_judged_and_never_passed(tmp_path: Path) -> None:
    finished = run_by(
        BOX,
        "mujoco-rk4",
        tmp_path,
        "always: {stop: false, energy: none}",
        "measure: {push: {kind: peak_force, body: box}}",
        "expect: [{name: push, measure: push, at_most: 1000}]",
    )
    words = {verdict.name: verdict.word for verdict in finished.verdicts}
    assert words.pop("push") == "not judged"
    left = {"always: impulses", "always: momentum", "always: residual"}
    assert {name for name, word in words.items() if word == "not judged"} == left
    assert {word for name, word in words.items() if name not in left} == {"passed"}
    assert not any(one.passed for one in finished.verdicts if not one.judged)
    assert finished.good  # nothing failed that was judged
    assert [one.judged for one in finished.run.results().checks] == [
        one.judged for one in finished.verdicts
    ]


@needs("mujoco")
def test_penetration_is_that_of_poses_whatever_the_engine_reports(tmp_path: Path) -> None:
    """A box that starts 10 mm inside the floor, by our geometry."""
    text = BOX.replace("position: [0, 0, 0.1]", "position: [0, 0, 0.09]")
    finished = run_by(text, "mujoco", tmp_path, "always: {stop: false, energy: none}")
    (deep,) = (one for one in finished.verdicts if one.name == "always: penetration")
    assert deep.measured >= 0.01 - 1e-15
    assert deep.measured == pytest.approx(0.01, rel=0.2)


@needs("mujoco")
@pytest.mark.parametrize("mu", [0.0, 0.8])
def test_a_contact_of_two_surfaces_has_the_friction_of_their_mixture(
    mu: float, tmp_path: Path
) -> None:
    """MuJoCo takes the larger; lavender sqrt(mu_a mu_b): 0 where one is frictionless."""
    text = BOX.replace(
        "rubber: {friction: 0.3}", f"rubber: {{friction: 0.3}}, other: {{friction: {mu}}}"
    )
    text = text.replace("kind: plane}, surface: rubber", "kind: plane}, surface: other")
    log = log_of(run_by(text, "mujoco", tmp_path))
    np.testing.assert_allclose(log.contact["friction"], (0.3 * mu) ** 0.5, rtol=1e-15)
