"""The arrows' ruler: readable for what is typical, honest about what is cut."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from synthetic_trace import CONTACT_FIELDS

from lavendersim.replay.force_scale import TYPICAL_LENGTH, force_scale, scene_size


def contacts(steps, forces):
    rows = np.zeros(len(steps), CONTACT_FIELDS)
    rows["step"], rows["force_n"] = steps, forces
    return rows


@pytest.mark.parametrize("weight", [1e-6, 9.81, 4.2e5])
def test_resting_weight_is_readable_however_hard_the_landing(weight):
    rested = contacts(range(1, 101), [500 * weight] + [weight] * 99)
    scale = force_scale(rested, diagonal=2.0)
    length = weight / scale.newtons_per_metre
    # the ruler is rounded to 1, 2, 3, 5: at worst by the square root of 2, between 1 and 2
    assert TYPICAL_LENGTH * 2.0 / 1.42 <= length <= TYPICAL_LENGTH * 2.0 * 1.42
    assert length < scale.cut


def test_heaviest_resting_contact_is_not_cut():
    """A ball that landed late weighs more than each corner of a box that rested throughout."""
    steps = np.repeat(np.arange(1, 101), 2)
    rested = contacts(steps, np.where(np.arange(200) % 2, 9.81, 2.45))
    rested["body_b"] = 1 + np.arange(200) % 2
    rested = rested[(rested["body_b"] == 1) | (rested["step"] > 80)]
    scale = force_scale(rested, diagonal=1.0)
    assert not scale.any_cut


def test_single_blow_does_not_shrink_the_resting_forces():
    blow = contacts([*range(1, 101), 50], [9.81] * 100 + [1e5])
    blow["body_b"][-1] = 7
    blow.sort(order="step")
    resting = contacts(range(1, 101), [9.81] * 100)
    assert force_scale(blow, 1.0).newtons_per_metre == force_scale(resting, 1.0).newtons_per_metre


def test_where_bodies_only_bounce_the_impacts_set_the_scale():
    scale = force_scale(contacts([10, 20, 30], [900.0, 1000.0, 1100.0]), diagonal=1.0)
    assert not scale.any_cut
    assert "cut" not in scale.label


def test_cut_arrow_has_the_cuts_length_and_is_marked():
    scale = force_scale(contacts(range(1, 12), [10.0] * 10 + [1e4]), diagonal=1.0)
    normals = np.tile([0.0, 0.6, 0.8], (2, 1))
    vectors, cut = scale.arrows(normals, np.array([10.0, 1e4]))
    assert cut.tolist() == [False, True]
    assert np.linalg.norm(vectors[1]) == pytest.approx(scale.cut, rel=1e-15)
    assert np.linalg.norm(vectors[0]) == pytest.approx(10 / scale.newtons_per_metre, rel=1e-15)
    assert f"1 m = {scale.newtons_per_metre:g} N" in scale.label
    assert "cut and red over" in scale.label


@pytest.mark.parametrize("forces", [[], [0.0], [np.nan]])
def test_recording_without_a_loaded_contact_still_has_a_scale(forces):
    assert force_scale(contacts(range(len(forces)), forces), 1.0).newtons_per_metre > 0


def test_contacts_without_features_are_taken_by_pairs():
    """As other engines log them."""
    rows = contacts(range(1, 101), [9.81] * 100)
    without = [name for name in rows.dtype.names if name != "feature"]
    assert force_scale(rows[without], 1.0) == force_scale(rows, 1.0)


def test_small_bodies_in_a_large_room_are_not_hidden_by_arrows():
    """Of balls of 56 mm on a table of 3 m arrows are a share of 16 balls, not of the table."""
    ball = SimpleNamespace(bounding_radius=0.028, fixed=False)
    table = SimpleNamespace(bounding_radius=2.0, fixed=True)
    assert scene_size(3.3, [ball] * 15 + [table]) == pytest.approx(16 * 0.056)
    assert scene_size(0.3, [ball] * 15 + [table]) == 0.3
    assert scene_size(0.3, [table]) == 0.3
