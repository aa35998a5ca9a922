"""Substeps as long as an accuracy allows: what is achieved, by closed forms, and that bits stay.

The error of a run is that of a place at its end, relative to the path up to there, or of the energy
at any time, relative to what it began with: what `accuracy` speaks of.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from shared_runs import GRAVITY, States, ball, config, flow, plane, run_scenes
from test_rolling_discs_at_second_order import DISC, UP, WHEEL

from lavendersim.engine.engine import Rows
from lavendersim.engine.records import DIVERGED, ROWS_FULL
from lavendersim.engine.step_doubling import MOST_SUBSTEPS
from lavendersim.experiment import load_experiment_text
from lavendersim.runner.cell import divergence
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of
from tests.families_of_plans import spec_of_family

ACCURACIES = (1e-4, 1e-5, 1e-6)
LONGEST = "1/60"
DOWN = repr(GRAVITY)
TABLE_RATE = 3.0  # [rad/s]
SHAKEN, SHAKES = 0.02, 3.0  # [m], [1/s]
CARRIED = "ball on a shaken table"


class Known(NamedTuple):
    """A scene, and how far a run of it is off, relative."""

    text: str
    error: Callable[[States], float]


def asking(text: str, accuracy: float, more: str = "") -> str:
    """Return the config with an accuracy in place of its timestep."""
    return re.sub(r"timestep: 1/\d+", f"timestep: {LONGEST}, accuracy: {accuracy!r}{more}", text)


def wheel(states: States) -> float:
    place, velocity, _ = states.of("disc")
    turned = WHEEL.precession * states.time[-1]
    forward, aside = velocity[0], np.cross(UP, velocity[0])
    way = (math.sin(turned) * forward + (1.0 - math.cos(turned)) * aside) / WHEEL.precession
    path = np.linalg.norm(velocity[0]) * states.time[-1]
    return float(np.linalg.norm(place[-1] - place[0] - way) / path)


def disc(states: States) -> float:
    energy = states.energy()
    return float(abs(energy / energy[0] - 1.0).max())


def table(rate: float) -> str:
    shape = "{kind: cylinder, radius: 2, length: 0.1}"
    turning = f"kinematic: true, angular_velocity: [0, 0, {rate!r}]"
    return f"{{shape: {shape}, {turning}, surface: one, position: [0, 0, -0.05]}}"


def block_on_a_table(states: States) -> float:
    """It sticks, so it goes round with the table."""
    place, _, _ = states.of("block")
    turned = TABLE_RATE * states.time[-1]
    there = 0.5 * np.array([math.cos(turned), math.sin(turned)])
    return float(np.linalg.norm(place[-1, :2] - there) / (0.5 * turned))


def ball_on_a_table(states: States) -> float:
    """v' = 2/7 Omega z x v (Earnshaw 1844): after a second it has gone half a circle."""
    place, _, _ = states.of("ball")
    there = np.array([0.3 - 1.2 / math.pi, 0.0])
    return float(np.linalg.norm(place[-1, :2] - there) / 0.6)


def link(states: States) -> float:
    """1 kg and 3 kg on a spring swing as 0.75 kg; the light one goes three quarters of it."""
    light, _, _ = states.of("light")
    heavy, _, _ = states.of("heavy")
    omega, amplitude = math.sqrt(29.6 / 0.75), 0.2
    stretch = heavy[-1, 0] - light[-1, 0] - 0.5 - amplitude * math.cos(omega * states.time[-1])
    path = 4.0 * amplitude * omega * states.time[-1] / (2.0 * math.pi)
    return float(abs(stretch) / path)


def bounce(states: States) -> float:
    """Falls h, d = A (1 - cos wt) + B sin wt while it presses, A = g/w^2, B = v/w, and on.

    At the worst time of the run: the law keeps the energy, so what is wrong is when it bounces, and
    at the apex, where the run ends, that moves it by next to nothing.
    """
    place, _, _ = states.of("ball")
    omega, height, time = math.sqrt(1.0 / 2e-4), 0.05, states.time
    fall = math.sqrt(2.0 * height / GRAVITY)
    a, b = GRAVITY / omega**2, GRAVITY * fall / omega
    pressed = 2.0 * (math.pi - math.atan(b / a)) / omega
    since = (time - fall) % (2.0 * fall + pressed)
    z = -(a * (1.0 - np.cos(omega * since)) + b * np.sin(omega * since))
    flown = since - pressed
    z = np.where(flown > 0.0, GRAVITY * (fall - 0.5 * flown) * flown, z)
    path = 2.0 * height * time[-1] / (2.0 * fall + pressed)
    return float(np.abs(place[:, 2] - 0.1 - z).max() / path)


def ball_on_a_shaken_table(states: States) -> float:
    """It goes where the table goes, which never falls as fast as gravity."""
    place, _, _ = states.of("ball")
    there = 0.1 + SHAKEN * math.sin(2.0 * math.pi * SHAKES * states.time[-1])
    return float(abs(place[-1, 2] - there) / (4.0 * SHAKEN * SHAKES * states.time[-1]))


def top(states: States) -> float:
    """A free symmetric top: its axis goes round its angular momentum with |L|/I."""
    turn = states.turn[-1, 0]
    across, along, spin = (3 * 0.01 + 0.01) / 12.0, 0.005, np.array([3.0, 0.0, 20.0])
    momentum = np.array([across * spin[0], 0.0, along * spin[2]])
    size = float(np.linalg.norm(momentum))
    angle, about = size / across * states.time[-1], momentum / size
    turned = UP * math.cos(angle) + np.cross(about, UP) * math.sin(angle)
    turned += about * (about @ UP) * (1.0 - math.cos(angle))
    w, x, y, z = turn
    axis = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
    off = np.linalg.norm(np.cross(axis, turned))
    return float(off / (np.linalg.norm(spin) * states.time[-1]))


def scenes() -> dict[str, Known]:
    """Return all scenes of this file by name."""
    rolling, nodding = (
        each.text(120, length, faster, "midpoint_contact")
        for each, length, faster in ((WHEEL, 1.0, 1.0), (DISC, 0.5, 1.1))
    )
    cube = "{kind: box, size: [0.1, 0.1, 0.1]}"
    block = f"{{shape: {cube}, mass: 1.0, surface: one, position: [0.5, 0, 0.05], "
    block += f"velocity: [0, {0.5 * TABLE_RATE}, 0], angular_velocity: [0, 0, {TABLE_RATE}]}}"
    riding = ball(0.1, 1.0, (0.3, 0, 0.1), (0, 0.6, 0))[:-1]
    riding += ", angular_velocity: [26.986722862692828, 0, 0]}"
    spinning = "{shape: {kind: cylinder, radius: 0.1, length: 0.1}, mass: 1.0, "
    spinning += "angular_velocity: [3, 0, 20], position: [0, 0, 0], surface: one}"
    swinging = {"light": ball(0.05, 1.0, (0, 0, 0)), "heavy": ball(0.05, 3.0, (0.7, 0, 0))}
    spring = "  springs:\n    - {a: light, b: heavy, stiffness: 29.6, rest_length: 0.5}\nnumerics"
    return {
        "wheel": Known(rolling, wheel),
        "disc": Known(nodding, disc),
        "block on a table": Known(
            config({"table": table(TABLE_RATE), "block": block}, 60, 3.0, "friction: 0.7", DOWN),
            block_on_a_table,
        ),
        "ball on a table": Known(
            config({"table": table(3.5 * math.pi), "ball": riding}, 60, 1.0, "friction: 1", DOWN),
            ball_on_a_table,
        ),
        "link": Known(config(swinging, 60, 1.9).replace("numerics", spring, 1), link),
        "bounce": Known(
            config(
                {"floor": plane(), "ball": ball(0.1, 1.0, (0, 0, 0.15))},
                *(60, 1.0, "compliance: 1e-4", DOWN),
            ),
            bounce,
        ),
        "top": Known(config({"top": spinning}, 60, 2.0), top),
    }


def carried() -> Known:
    shaken = "{shape: {kind: box, size: [1, 1, 0.2]}, kinematic: true, position: [0, 0, -0.1], "
    shaken += "surface: one, motion: [{displacement: [0, 0, "
    shaken += f"{SHAKEN}], factor: {{kind: sine, frequency: {SHAKES}}}}}]}}"
    riding = ball(0.1, 1.0, (0, 0, 0.1), (0, 0, 2.0 * math.pi * SHAKES * SHAKEN))
    text = config({"table": shaken, "ball": riding}, 60, 0.45, "friction: 0.7", DOWN)
    return Known(text, ball_on_a_shaken_table)


def all_scenes() -> dict[str, Known]:
    return scenes() | {CARRIED: carried()}


@pytest.fixture(scope="module")
def ran() -> dict[tuple[str, float], States]:
    texts = {
        f"{name} {accuracy}": asking(known.text, accuracy)
        for name, known in all_scenes().items()
        for accuracy in ACCURACIES
    }
    found = run_scenes(texts)
    return {(name, each): found[f"{name} {each}"] for name in all_scenes() for each in ACCURACIES}


@pytest.fixture(scope="module")
def achieved(ran: dict[tuple[str, float], States]) -> dict[tuple[str, float], float]:
    known = all_scenes()
    return {case: known[case[0]].error(states) / case[1] for case, states in ran.items()}


@pytest.mark.parametrize("name", all_scenes())
def test_no_error_is_ten_times_what_is_asked_for(
    achieved: dict[tuple[str, float], float], name: str
) -> None:
    assert all(achieved[name, accuracy] <= 10.0 for accuracy in ACCURACIES)


def test_errors_are_a_tenth_of_what_is_asked_for_in_nine_of_ten_cases(
    achieved: dict[tuple[str, float], float],
) -> None:
    """What is more accurate than that was paid for and not asked for."""
    enough = [share >= 0.1 for (name, _), share in achieved.items() if name != CARRIED]
    assert sum(enough) >= 0.9 * len(enough)


def test_estimates_add_up_to_what_they_may(ran: dict[tuple[str, float], States]) -> None:
    """Three times the accuracy in smooth motion, once more at kinks."""
    for (_, accuracy), states in ran.items():
        assert 0.0 < states.step["estimated_error"].sum() <= 4.0 * accuracy


def test_substeps_are_fewer_where_less_is_asked_for(
    ran: dict[tuple[str, float], States],
) -> None:
    """Of order 2, so sqrt(10) as many for a tenth of the error; 2 at least, 5 at most."""
    for name in scenes():
        counts = [int(ran[name, accuracy].step["substeps"].sum()) for accuracy in ACCURACIES]
        fewest = 2 * (len(ran[name, ACCURACIES[0]].step) - 1)  # the first row is the start
        for few, many in itertools.pairwise(counts):
            assert few == fewest or 2.0 * few <= many <= 5.0 * few


def test_what_is_carried_takes_no_more_substeps_than_its_error_asks_for(
    ran: dict[tuple[str, float], States],
) -> None:
    """As above, at most 5 times as many for a tenth. Velocities that depend on the length of a
    substep would be counted as errors at every one, and take 10 times as many.
    """
    counts = [int(ran[CARRIED, accuracy].step["substeps"].sum()) for accuracy in ACCURACIES]
    assert all(many <= 5.0 * few for few, many in itertools.pairwise(counts))


def test_what_is_exact_takes_the_longest_substeps() -> None:
    """Flight and its impacts are without an error, whatever is asked for."""
    bodies = {"floor": plane(), "ball": ball(0.1, 1.0, (0, 0, 1.0)), "brick": BRICK}
    text = asking(config(bodies, 60, 2.0, "restitution: 0.8", DOWN), 1e-8)
    (states,) = run_scenes({"bounces": text}).values()
    assert (states.step["substeps"][1:] == 2).all()
    assert (states.step["rejected"] == 0).all()


# At rest, far from the others: the scene requires the plan that all share.
BRICK = "{shape: {kind: box, size: [0.1, 0.1, 0.1]}, mass: 1, surface: one, position: [0, 9, 0.05]}"


def rows_of(text: str, block_steps: int, capacity: int = 0) -> tuple[Any, list[Rows]]:
    """Return the engine after a run and its rows; capacity: rows of contacts from the start."""
    (cell,) = load_experiment_text(text, "x.yaml").cells()
    spec = spec_of_family(plan_of(cell.config))
    engine = build(cell.config, spec).engine(spec, block_steps)
    if capacity:
        engine._grow_contacts(capacity)
    rows, last = [], cell.config.steps
    while True:
        status = engine.advance(last - int(engine.counters["step"][0]))
        rows.append(engine.take_rows())
        if status == DIVERGED or int(engine.counters["step"][0]) == last:
            return engine, rows


def tumbling() -> str:
    """Two boxes fall on each other at an angle, and ask for more rows than there are at first."""
    shape = "{kind: box, size: [0.2, 0.2, 0.1]}"
    boxes = {
        name: f"{{shape: {shape}, mass: 1.0, surface: one, position: [0, {0.01 * i}, {height}], "
        f"orientation: {flow((math.cos(0.4 * i), 0.02 * i, 0, math.sin(0.4 * i)))}}}"
        for i, (name, height) in enumerate({"lower": 0.06, "upper": 0.18}.items())
    }
    text = config({"floor": plane(), **boxes}, 60, 0.15, "friction: 0.5", DOWN)
    return asking(text, 1e-3)


def test_rows_are_the_same_however_memory_grows_within_a_step() -> None:
    """A substep that finds its columns full is taken back and made again."""
    engine, whole = rows_of(tumbling(), 512, capacity=1024)
    assert int(engine.counters["step"][0]) == 9
    assert sum(int(rows.step["rejected"].sum()) for rows in whole) > 0
    for block_steps in (1, 5):
        other, parts = rows_of(tumbling(), block_steps)
        assert len(other.contacts) < 1024
        for table in ("step", "contact", "pose"):
            one, two = (
                np.concatenate([getattr(rows, table) for rows in each]) for each in (whole, parts)
            )
            assert one.tobytes() == two.tobytes()


def test_a_sleeping_body_wakes_within_a_substep() -> None:
    """Rolling balls; a head-on elastic impact of equal masses hands all of the speed on."""
    bodies = {
        "floor": plane(),
        "sleeper": ball(0.1, 1.0, (0, 0, 0.1)),
        "runner": ball(0.1, 1.0, (-1.5, 0, 0.1), (1.0, 0, 0)),
        "brick": BRICK,
    }
    text = asking(config(bodies, 60, 2.0, "restitution: 1", DOWN), 1e-4, ", sleeping: true")
    engine, rows = rows_of(text, 512)
    awake = np.concatenate([each.step["awake"] for each in rows])
    assert awake.min() == 1
    assert engine.velocities["vx"][1:3] == pytest.approx([1.0, 0.0], abs=1e-9)


def test_a_run_that_cannot_be_so_accurate_ends_with_a_sentence() -> None:
    text = asking(WHEEL.text(120, 1.0, 1.0, "midpoint_contact"), 1e-9, ", smallest_timestep: 1e-3")
    (cell,) = load_experiment_text(text, "x.yaml").cells()
    spec = spec_of_family(plan_of(cell.config))
    scene = build(cell.config, spec)
    engine = scene.engine(spec)
    assert engine.advance(cell.config.steps) == DIVERGED
    begin = engine.bodies[1].copy()
    sentence = divergence(scene, engine)
    assert re.fullmatch(
        r"diverged: body disc cannot be made as accurate as asked for \(1e-09\): the estimated "
        r"error of a substep of 0\.00\d+ s is \d\.\d+e-\d+, and none may be shorter than 0.001 s, "
        r"after step 0 \(t = 0 s\)",
        sentence,
    )
    # It stands where the substep began, and is there again.
    assert engine.advance(cell.config.steps) == DIVERGED
    assert engine.bodies[1].tobytes() == begin.tobytes()


def test_a_step_of_too_many_substeps_ends_with_a_sentence() -> None:
    """At 1e-6 the wheel takes 2000 substeps a second; at 1e-9, by order 2, 30 times as many."""
    text = asking(WHEEL.text(1, 1.0, 1.0, "midpoint_contact"), 1e-9)
    text = text.replace(f"timestep: {LONGEST}", "timestep: 1")
    (cell,) = load_experiment_text(text, "x.yaml").cells()
    spec = spec_of_family(plan_of(cell.config))
    scene = build(cell.config, spec)
    engine = scene.engine(spec)
    while (status := engine.advance(1)) == ROWS_FULL:
        engine.take_rows()
    assert status == DIVERGED
    assert engine.counters["substeps"][0] == MOST_SUBSTEPS
    begin = engine.bodies[1].copy()
    sentence = divergence(scene, engine)
    assert re.fullmatch(
        r"diverged: body disc cannot be made as accurate as asked for \(1e-09\): the estimated "
        r"error of a substep of \S+ s is \d\.\d+e-\d+, and its step has had 4096 substeps, "
        r"after step 0 \(t = 0\.\d+ s\)",
        sentence,
    )
    assert engine.advance(1) == DIVERGED
    assert engine.bodies[1].tobytes() == begin.tobytes()
