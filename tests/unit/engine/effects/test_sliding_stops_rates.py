"""The rate of a spin in a part of a step: what it gained, over the part's length."""

from __future__ import annotations

import numpy as np
from interpreted import interpreted
from plain_facts import one_row, vector_fields

from lavendersim.engine.effects.sliding_stops import make_note_rate
from lavendersim.engine.spec import Spec


def test_the_rate_of_a_spin_is_its_change_over_the_part(rng) -> None:
    before, after, dt = rng.normal(size=3), rng.normal(size=3), 0.125
    body = one_row(spin_ax=0.0, spin_ay=0.0, spin_az=0.0)
    rows = (one_row(**vector_fields("w", spin)) for spin in (after, before))
    interpreted(make_note_rate(Spec()))(body, *rows, dt)
    found = [body[f"spin_a{axis}"] for axis in "xyz"]
    np.testing.assert_array_equal(found, (after - before) / dt)  # dt is a power of two
