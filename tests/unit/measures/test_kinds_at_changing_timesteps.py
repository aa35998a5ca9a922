"""Steps of 10 ms, then of 20 ms: measures take the length of each step, or say why they cannot."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import numpy.lib.recfunctions as recfunctions
import pytest
from pydantic import TypeAdapter
from synthetic import GRAVITY, MASS, contacts, log_of, scene_of, spinning_log, trace_of

from lavendersim.clock import Clock
from lavendersim.errors import UsageError
from lavendersim.measures import balance, evaluate
from lavendersim.measures.contact_sums import nothing, summed
from lavendersim.measures.specs import optimality as specs
from lavendersim.measures.specs.catalogue import MeasureSpec
from lavendersim.measures.step_checks import NUMBERS
from lavendersim.measures.step_passes import OVER_LOGS

FIRST = 10  # steps of 10 ms
CLOCK = Clock(Fraction(1, 100), [(Fraction(1, 10), Fraction(1, 50))])
COUNT = 31
TIMES = np.array([float(CLOCK.time(step)) for step in range(COUNT)])
LENGTHS = CLOCK.lengths(np.arange(COUNT))
FLOOR = {"shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}}
CUBE = {"shape": {"kind": "box", "size": [0.2, 0.2, 0.2]}, "mass": MASS}
LAST = float(TIMES[-1])


def spec(kind: str, **values: Any) -> Any:
    return TypeAdapter(MeasureSpec).validate_python({"kind": kind} | values)


def timed(log: Any) -> Any:
    log.clock = CLOCK
    log.step["time"] = TIMES[: len(log.step)]
    return log


def cruising() -> Any:
    """A cube that goes at 3 m/s along x, whatever the length of its steps."""
    places = np.zeros((COUNT, 1, 3))
    places[:, 0, 0] = 3.0 * TIMES
    return timed(log_of(scene_of({"cube": CUBE}), places))


def test_speeds_are_ways_over_the_time_that_they_took() -> None:
    log = cruising()
    along = (1.0, 0.0, 0.0)
    means = {
        "mean_velocity": {"body": "cube", "along": along},
        "top_speed": {},
        "creep": {"body": "cube", "last": 0.35},
    }
    for kind, values in means.items():
        # a way of 3 cm between places of 1.2 m is good to 1e-14 of itself
        assert evaluate(spec(kind, **values), log) == pytest.approx(3.0, rel=2e-14), kind
    speeds, _ = NUMBERS["speed"](log, nothing(len(log.step)), OVER_LOGS)
    assert speeds[1:] == pytest.approx(3.0, rel=2e-14)


def test_a_resting_body_weighs_the_same_in_steps_of_any_length() -> None:
    touching = [(step, MASS * GRAVITY * LENGTHS[step], 0.0) for step in range(1, COUNT)]
    log = timed(trace_of([0.0] * COUNT, touching))
    force = spec("force_error", last=LAST)
    assert evaluate(force, log) < 1e-15
    log.clock = Clock(Fraction(1, 100))
    assert evaluate(force, log) == pytest.approx(1.0)


def test_compliance_is_divided_by_the_square_of_each_step() -> None:
    """c lambda / dt^2 = -v_n in a step of 10 ms and in one of 20 ms."""
    compliance, impulse = 1e-4, 0.5
    body = {"shape": {"kind": "sphere", "radius": 0.1}, "mass": MASS}
    scene = scene_of({"floor": FLOOR, "ball": body | {"surface": {"compliance": compliance}}})
    log = timed(log_of(scene, np.zeros((COUNT, 2, 3))))
    rows = contacts([(3, impulse, 0.0), (20, impulse, 0.0)])
    rows["normal_velocity"] = -compliance * impulse / LENGTHS[rows["step"]] ** 2
    log.contact = recfunctions.append_fields(rows, "target", [0.0, 0.0], usemask=False)
    found = evaluate(specs.Optimality(kind="optimality"), log)
    assert found[1] < 1e-15 * 0.5  # of the 0.5 m/s that cancel


def test_momentum_is_balanced_over_the_length_of_each_step() -> None:
    log = timed(trace_of([0.0] * COUNT))
    log.step["momentum_z"] = -MASS * GRAVITY * TIMES
    log.step["kinetic_energy"] = 0.5 * MASS * (GRAVITY * TIMES) ** 2
    log.absent = {"/contacts": "nothing can touch"}
    assert balance.momentum_imbalance(log, summed(log)).max() < 1e-15
    log.clock = Clock(Fraction(1, 100))
    assert balance.momentum_imbalance(log, summed(log)).max() > 0.01


def bouncing(apex: int) -> Any:
    """A parabola in time with its vertex of 1 m at a row, that touches in its first step."""
    heights = 1.0 - 0.5 * GRAVITY * (TIMES - TIMES[apex]) ** 2
    return timed(trace_of(heights.tolist(), [(1, 1.0, 0.0)]))


@pytest.mark.parametrize("apex", [FIRST - 4, FIRST + 5])
def test_an_apex_is_found_by_samples_of_one_distance_wherever_the_change_is(apex: int) -> None:
    height = spec("first_apex", body="ball", above="floor")
    assert evaluate(height, bouncing(apex)) == pytest.approx(1.0, rel=1e-14)


@pytest.mark.parametrize(
    ("kind", "values", "log"),
    [
        ("first_apex", {"body": "ball", "above": "floor"}, bouncing(FIRST)),
        ("flip_time_error", {"body": "top", "flips": 1}, spinning_log()),
    ],
)
def test_what_needs_equal_distances_says_so(kind: str, values: Any, log: Any) -> None:
    log.clock = CLOCK
    said = f"{kind} takes samples at equal distances, and the timestep changes among those"
    with pytest.raises(UsageError, match=said):
        evaluate(spec(kind, **values), log)


def test_friction_is_found_by_a_window_of_one_timestep() -> None:
    """A cube that slides down 45 degrees without friction."""
    pull = GRAVITY * 0.5**0.5
    scene = scene_of({"floor": FLOOR, "cube": CUBE}, gravity=[pull, 0.0, -pull])
    places = np.zeros((COUNT, 2, 3))
    places[:, 1, 0] = 0.5 * pull * TIMES**2
    log = timed(log_of(scene, places))
    friction = spec("effective_friction", body="cube", on="floor", last=0.3)
    # places of 0.9 m good to 1e-16, over (0.14 s)^2, by 7 m/s^2
    assert evaluate(friction, log) == pytest.approx(0.0, abs=1e-14)
    with pytest.raises(UsageError, match=r"from 0\.08 to 0\.5 s"):
        evaluate(friction.model_copy(update={"last": 0.415}), log)
