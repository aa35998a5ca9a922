"""`--at`: the time a replay stands still at."""

from __future__ import annotations

import pytest

from lavendersim import replay
from lavendersim.errors import UsageError
from lavendersim.replay.recording import moment_to_show


@pytest.mark.parametrize("at", [0.0, 0.5, 1.234, 1.9999, 2.0, 2.002])
def test_the_step_nearest_to_a_time_is_shown(two_bodies, at):
    # 240 Hz for 2 s; half a step more is still the last one's
    shown = int(moment_to_show(two_bodies, at).astype("int64")) * 1e-9
    assert abs(shown - min(at, 2.0)) <= 0.5 / 240 + 1e-9
    assert shown * 240 == pytest.approx(round(shown * 240), abs=1e-6)


@pytest.mark.parametrize("at", [-0.01, 2.01])
def test_a_time_outside_the_log_is_refused_with_its_ends(two_bodies, tmp_path, at):
    with pytest.raises(UsageError, match=r"this log goes from 0 to 2 s"):
        replay.screenshot(two_bodies, tmp_path / "never.png", at=at)
    assert list(tmp_path.iterdir()) == []
