"""A body that is removed stays where it was and takes part in nothing; what it bore falls.

Two balls stand on the floor, 3 m below where potential energy is 0. A guest begins within them or
far off and is removed before the first step, or begins far off and is removed in free fall. The
floor goes at 0.6 s. Once with pairs that are listed, once with those that the engine finds.
"""

from __future__ import annotations

import io
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.image import imread

import lavendersim
from lavendersim.figures.style import LOOKS
from lavendersim.figures.thumbnail import thumbnail
from lavendersim.runner.experiment_run import Finished
from lavendersim.trace import Trace, open_trace
from lavendersim.trace.reader import RecordedPoses

G = 9.81
SCENE = """
scene:
  surfaces: {rubber: {friction: 0.5}}
  bodies:
    floor: {shape: {kind: plane, offset: -3}, surface: rubber}
    low: {shape: {kind: sphere, radius: 0.1}, mass: 1, surface: rubber, position: [0, 0, -2.9]}
    guest: {shape: {kind: sphere, radius: 0.1}, mass: 7, surface: rubber, position: [5, 0, -2]}
    high: {shape: {kind: sphere, radius: 0.1}, mass: 2, surface: rubber, position: [0, 0, -2.7]}
events:
  - {at: 0, body: guest, remove: true}
  - {at: 0.6, body: floor, remove: true}
duration: 1.0
always: {}
sweep:
  - pairs: {path: effects.broad_phase, values: [off, on]}
    x: {path: scene.bodies.guest.position.0, values: [0.05, 5]}
    z: {path: scene.bodies.guest.position.2, values: [-2.8]}
  - pairs: {path: effects.broad_phase, values: [off, on]}
    at: {path: events.0.at, values: [0.3]}
"""
BOTH = pytest.mark.parametrize("pairs", ["off", "on"])
GUEST = 2
SUMS = ("kinetic_energy", "potential_energy", "momentum_x", "momentum_z", "angular_momentum_y")


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Finished:
    folder = tmp_path_factory.mktemp("removed")
    config = folder / "removed.yaml"
    config.write_text(SCENE)
    return lavendersim.run(config, root=folder)


def trace(finished: Finished, pairs: str, **coordinates: Any) -> Trace:
    (cell,) = (
        one
        for one in finished.run.cells
        if {"pairs": pairs, **coordinates}.items() <= one.coordinates.items()
    )
    return open_trace(cell.path)


def rest(log: Trace, first: int) -> bytes:
    """Return what a log says of all but the guest, from a row on."""
    parts = [log.pose[first:, [0, 1, 3]]]
    contacts = log.contact[log.contact["step"] >= log.step["step"][first]]
    parts += [contacts[name] for name in ("body_a", "body_b", "impulse_n", "residual")]
    parts += [log.step[name][first:] for name in SUMS]
    return b"".join(np.ascontiguousarray(part).tobytes() for part in parts)


@BOTH
def test_where_it_stood_makes_no_difference_to_the_bit(finished: Finished, pairs: str) -> None:
    within, far = (trace(finished, pairs, x=x) for x in (0.05, 5))
    assert rest(within, 1) == rest(far, 1)
    assert (within.contact["body_b"] != GUEST).all()


@BOTH
def test_it_stays_in_its_last_place_and_out_of_all_sums(finished: Finished, pairs: str) -> None:
    falling, gone = trace(finished, pairs, at=0.3), trace(finished, pairs, x=5)
    last = int(np.searchsorted(falling.step["time"], 0.3 - 1e-9))  # the state it is removed in
    assert last == 72
    fallen = -2.0 - falling.pose[last, GUEST, 2]
    assert fallen == pytest.approx(0.5 * G * 0.3**2, rel=1e-12)  # 72 steps round places of 2 m
    assert (falling.pose[last:, GUEST] == falling.pose[last, GUEST]).all()
    assert rest(falling, last + 1) == rest(gone, last + 1)
    energy = falling.step["kinetic_energy"] + falling.step["potential_energy"]
    assert energy[0] == pytest.approx(-G * (7 * 2.0 + 1 * 2.9 + 2 * 2.7), rel=1e-15)
    assert energy[last + 1] == pytest.approx(-G * (1 * 2.9 + 2 * 2.7), rel=1e-9)


@BOTH
def test_what_it_bore_falls(finished: Finished, pairs: str) -> None:
    """Balls may have moved by the slop and by creep at the tolerance: 2e-7 m, 2e-9 m/s."""
    log = trace(finished, pairs, x=5)
    first = 144  # 0.6 s
    time = np.maximum(log.step["time"] - 0.6, 0.0)
    for body, height in ((1, -2.9), (3, -2.7)):
        expected = height - 0.5 * G * time**2
        assert np.abs(log.pose[:, body, 2] - expected).max() < 2e-7 + 0.4 * 2e-9
    assert (log.step["contact_count"][1 : first + 1] > 0).all()
    assert (log.contact["body_a"][log.contact["step"] > first] != 0).all()


def test_energy_and_momentum_know_what_was_taken(finished: Finished) -> None:
    assert finished.good, [verdict.message for verdict in finished.verdicts if not verdict.passed]
    assert {verdict.name for verdict in finished.verdicts} >= {
        "always: energy", "always: momentum"
    }  # fmt: skip


def test_a_thumbnail_shows_it_as_long_as_it_is_there(finished: Finished) -> None:
    log = trace(finished, "off", at=0.3)
    shown = []
    for states in (73, 74):
        part = SimpleNamespace(
            step=log.step[:states],
            recorded_pose=RecordedPoses(np.arange(states), log.pose[:states]),
            bodies=log.bodies,
            config=log.config,
            events=log.events,
            clock=log.clock,
        )
        picture = imread(io.BytesIO(thumbnail(part)))[:, :, :3]
        shown.append(bool((np.abs(picture - to_rgb(LOOKS[GUEST].colour)).max(axis=2) < 0.01).any()))
    assert shown == [True, False]
