"""What numbers of contacts are expected to be: every predictor's inverse, and what it saves."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.engine import difference_kernel
from lavendersim.trace import predictors
from lavendersim.trace.contact_columns import pack, unpack

NAMES = (
    *("body_a", "feature", "x", "nx", "ny", "nz", "normal_velocity", "approach_velocity"),
    *("separation", "target"),
)
STEPS, KEYS = 300, 5
CONSTANTS = predictors.Constants(timestep=1.0 / 240.0, slop=1e-7)


def rows_of(**columns: np.ndarray) -> np.ndarray:
    """Return KEYS contacts on each of STEPS steps; what is not given is noise of every kind."""
    random = np.random.default_rng(3)
    rows = np.zeros(STEPS * KEYS, [(n, "i8" if n in NAMES[:2] else "f8") for n in NAMES])
    rows["feature"] = np.tile(np.arange(KEYS), STEPS)
    for name in NAMES[2:]:
        bits = random.integers(-(2**63), 2**63 - 1, len(rows))
        rows[name] = columns.get(name, bits.view(np.float64))
    return rows


def chosen(rows: np.ndarray) -> dict[str, int]:
    """Return the predictor of each column of rows that come back bit for bit."""
    packed = pack([rows], NAMES, CONSTANTS)
    table = np.zeros(len(rows), rows.dtype)
    unpack(packed, NAMES, table)
    assert table.tobytes() == rows.tobytes()
    return dict(zip(NAMES[2:], packed.predictors, strict=True))


def heavy_bytes(rows: np.ndarray, name: str) -> int:
    """Return the bytes of a column that are not zeros before its first digit."""
    packed = pack([rows], NAMES, CONSTANTS)
    planes = np.frombuffer(packed.planes, np.uint8).reshape(8, len(NAMES) - 2, len(rows))
    column = planes[:, NAMES.index(name) - 2]
    return int((np.cumsum(column != 0, axis=0) > 0).sum())


def test_the_kernel_and_its_inverse_number_predictors_alike() -> None:
    for name in ("XOR", "DELTA", "LINEAR", "UNIT", "AFTER", "GAP", "LAW", "SPHERES", "COUNT"):
        assert getattr(predictors, name) == getattr(difference_kernel, name)
    assert max(predictors.ALONE) + 1 == difference_kernel.ALONE == predictors.UNIT


def test_noise_of_every_bit_pattern_returns() -> None:
    chosen(rows_of())


def test_a_straight_line_costs_nothing_after_two_rows_of_a_key() -> None:
    """Numbers of equal spacing between 1 and 2 have bits of equal spacing: differences are 0."""
    line = 1.0 + np.arange(STEPS).repeat(KEYS) * 2.0**-20 + np.tile(np.arange(KEYS), STEPS) / 8
    rows = rows_of(x=line)
    assert chosen(rows)["x"] == predictors.LINEAR
    assert heavy_bytes(rows, "x") <= 2 * KEYS * 8


def test_what_stays_near_costs_its_last_bytes() -> None:
    """Steps of at most 2^-30 to either side of 1.5 are 2^22 ulp: 23 bits and a sign, 3 bytes."""
    random = np.random.default_rng(5)
    rows = rows_of(x=1.5 + 2.0**-31 * random.uniform(-1.0, 1.0, STEPS * KEYS))
    assert chosen(rows)["x"] in (predictors.XOR, predictors.DELTA)
    assert heavy_bytes(rows, "x") <= 3 * len(rows) + 8 * KEYS


def test_the_third_component_of_a_normal_costs_its_rounding() -> None:
    random = np.random.default_rng(7)
    n = random.normal(size=(3, STEPS * KEYS))
    n /= np.sqrt(n[0] ** 2 + n[1] ** 2 + n[2] ** 2)
    n[2] = np.abs(n[2])
    rows = rows_of(nx=n[0], ny=n[1], nz=n[2])
    assert chosen(rows)["nz"] == predictors.UNIT
    # The error of 1 - x^2 - y^2 is at most 2 ulp of 1, divided by 2 nz^2 relative to nz: below
    # 2^8 ulp, one byte, where nz > 2^-4; smaller ones are rare (uniform in height: one in 16).
    assert heavy_bytes(rows, "nz") <= 2 * len(rows)


def test_a_velocity_that_goes_on_costs_its_change() -> None:
    random = np.random.default_rng(9)
    after = random.normal(size=STEPS * KEYS)
    before = np.concatenate([random.normal(size=KEYS), after[:-KEYS]])
    rows = rows_of(normal_velocity=after, approach_velocity=before)
    assert chosen(rows)["approach_velocity"] == predictors.AFTER
    assert heavy_bytes(rows, "approach_velocity") <= 8 * KEYS


def test_the_target_of_a_gap_costs_nothing() -> None:
    """Every row asks to close what is beyond the slop within the timestep, each rounded alike."""
    random = np.random.default_rng(11)
    separation = random.uniform(-1e-6, 1e-6, STEPS * KEYS)
    target = [max(one - 1e-7, 0.0) / (1.0 / 240.0) for one in separation.tolist()]
    rows = rows_of(separation=separation, target=np.array(target))
    assert chosen(rows)["target"] == predictors.GAP
    assert heavy_bytes(rows, "target") == 0


@pytest.mark.parametrize("value", [np.nan, np.inf, -0.0, 5e-324, 1e308])
def test_normals_that_are_none_return(value: float) -> None:
    n = np.full(STEPS * KEYS, value)
    chosen(rows_of(nx=n, ny=n, nz=n))
