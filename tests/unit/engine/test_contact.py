"""k_n of a logged contact equals J M^-1 J^T with full 6 x 6 matrices, off centre and tumbling."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import Bench, box, plane, resolved, sphere
from rows import RowOracle

SCENES = {
    "box on plane": {
        "floor": plane(),
        "box": box((1.0, 0.6, 0.4), (0.3, 0.1, 0.199), mass=3.0, orientation=(1.0, 0.01, 0.0, 0.5)),
    },
    "tumbling boxes": {
        "a": box((1.0, 0.6, 0.4), (0.0, 0.0, 0.0), mass=3.0, orientation=(0.8, 0.1, 0.3, 0.5)),
        "b": box((0.7, 0.7, 0.9), (0.3, 0.4, 0.6), mass=0.2, orientation=(0.1, 0.9, 0.2, 0.1)),
    },
    "sphere off the centre of a box": {
        "a": box((1.0, 1.0, 0.2), (0.0, 0.0, 0.0), mass=2.0),
        "b": sphere(0.1, (0.4, 0.3, 0.199), mass=0.5),
    },
    "two spheres": {
        "a": sphere(0.2, (0.0, 0.0, 0.0), mass=2.0),
        "b": sphere(0.1, (0.1, 0.2, 0.1), mass=0.5),
    },
}


@pytest.mark.parametrize("name", SCENES)
def test_inverse_effective_mass_is_the_diagonal_of_the_delassus_operator(name):
    bench = Bench(resolved(SCENES[name]))
    oracle = RowOracle(bench)
    rows = bench.run(1).contact
    assert len(rows)
    expected = np.diag(oracle.delassus(rows))
    # Some hundred roundings.
    np.testing.assert_allclose(rows["inverse_effective_mass"], expected, rtol=1e-13)


def test_a_box_touched_at_its_rim_follows_the_closed_form():
    """Beside the centre by s: k = 1/m + s^2/I, I = m (a^2 + c^2)/12 about the axis across."""
    for s in (0.0, 0.1, 0.2, 0.3):
        bodies = {
            "box": box((1.0, 0.5, 0.2), (0.0, 0.0, 0.0), mass=2.0),
            "pin": sphere(0.05, (s, 0.0, 0.1499), fixed=True),
        }
        row = Bench(resolved(bodies)).run(1).contact[0]
        inertia = 2.0 / 12.0 * (1.0**2 + 0.2**2)
        assert row["inverse_effective_mass"] == pytest.approx(0.5 + s * s / inertia, rel=1e-14)
