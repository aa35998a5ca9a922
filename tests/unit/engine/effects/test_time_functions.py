"""Ramps, sines, pulses and tables have the values of their formulas, and say where they jump."""

from __future__ import annotations

import numpy as np
import pytest
from pydantic import TypeAdapter

from lavendersim.engine.effects.time_functions import CONSTANT, Terms, TimeFunction, terms_of

MODEL = TypeAdapter(TimeFunction)


def made(**fields) -> Terms:
    return MODEL.validate_python(fields).terms()


def value(terms: Terms, t: float) -> float:
    """Return g(t) + a sin(omega t + phi), right of a jump, by the definition of the form."""
    times, values = (np.array(column) for column in zip(*terms.knots, strict=True))
    k = int(np.searchsorted(times, t, side="right")) - 1
    if k < 0:
        line = values[0]
    elif k == len(times) - 1:
        line = values[-1] + terms.slope * (t - times[-1])
    else:
        line = np.interp(t, times[k : k + 2], values[k : k + 2])
    return float(line + terms.amplitude * np.sin(terms.omega * t + terms.phase))


TIMES = [0.0, 0.3, 0.5, 1.0, 1.7, 2.0, 5.0]


@pytest.mark.parametrize("t", TIMES)
def test_formulas(t: float) -> None:
    ramp = made(kind="ramp", rate=3.0, **{"from": 0.5, "to": 1.7})
    assert value(ramp, t) == pytest.approx(3.0 * np.clip(t - 0.5, 0.0, 1.2), abs=1e-14)
    endless = made(kind="ramp", **{"from": 0.5})
    assert value(endless, t) == pytest.approx(max(t - 0.5, 0.0), abs=1e-14)
    sine = made(kind="sine", frequency=2.0, amplitude=0.5, phase_degrees=90.0, offset=1.5)
    assert value(sine, t) == pytest.approx(1.5 + 0.5 * np.cos(4.0 * np.pi * t), abs=1e-13)
    pulse = made(kind="pulse", **{"from": 0.5, "to": 1.7})
    assert value(pulse, t) == float(0.5 <= t < 1.7)
    table = made(kind="table", times=[0.3, 1.0, 2.0], values=[1.0, -2.0, 4.0])
    assert value(table, t) == pytest.approx(
        np.interp(t, [0.3, 1.0, 2.0], [1.0, -2.0, 4.0]), abs=1e-14
    )
    assert value(terms_of(None), t) == value(CONSTANT, t) == 1.0


def test_only_a_pulse_jumps() -> None:
    assert made(kind="pulse", **{"from": 0.5, "to": 1.7}).jumps
    assert not made(kind="ramp", **{"from": 0.5, "to": 1.7}).jumps
    assert not made(kind="table", times=[0.0, 1.0], values=[0.0, 5.0]).jumps
    assert not Terms(((0.0, 1.0), (0.0, 1.0))).jumps


def test_no_slope_is_steeper_than_the_steepest(rng) -> None:
    for terms, expected in (
        (made(kind="ramp", rate=-3.0, **{"from": 0.5, "to": 1.7}), 3.0),
        (made(kind="ramp", rate=-3.0), 3.0),
        (made(kind="sine", frequency=2.0, amplitude=-0.5), 2.0 * np.pi),
        (made(kind="table", times=[0.0, 1.0, 1.5], values=[0.0, 1.0, -1.0]), 4.0),
        (made(kind="pulse", **{"from": 0.5, "to": 1.7}), 0.0),
    ):
        assert terms.steepest == pytest.approx(expected, rel=1e-14)
