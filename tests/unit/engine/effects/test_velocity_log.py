"""Velocities in the log: those that each step ends with, of every body, in world axes."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import Bench, body, planned, resolved, sphere

from lavendersim.cell import CellRecord
from lavendersim.engine.spec import Spec

G, RATE, STEPS = 9.81, 240, 48
LOGS = ("gravity", "kinematic", "pose_log", "rotation", "step_log")


def fall(*effects: str) -> Bench:
    """A ball thrown and spun, and a kinematic one that turns; nothing touches."""
    bodies = {
        "ball": sphere(0.1, (0, 0, 5), velocity=(1, 2, 3), angular_velocity=(4, 5, 6)),
        "lift": body(
            {"kind": "box", "size": [1, 1, 1]}, (9, 9, 9), kinematic=True,
            velocity=(0, 0, 0.5), angular_velocity=(0, 7, 0),
        ),
    }  # fmt: skip
    cell = resolved(bodies, (0.0, 0.0, -G), timestep=f"1/{RATE}")
    return Bench(cell, spec=Spec(effects=tuple(sorted({*LOGS, *effects})), shape_pairs=()))


def test_a_row_has_the_velocities_that_its_step_ends_with() -> None:
    """v = v0 - g t, to a rounding of each of 48 steps; a spin that nothing changes, to the bit."""
    pose = fall("velocity_log").run(STEPS).pose
    time = np.arange(STEPS + 1) / RATE
    ball, lift = pose[:, 0, 7:], pose[:, 1, 7:]
    np.testing.assert_allclose(ball[:, 2], 3.0 - G * time, rtol=0, atol=STEPS * 4.4e-16)
    assert (ball[:, [0, 1, 3, 4, 5]] == [1, 2, 4, 5, 6]).all()
    assert (lift == [0, 0, 0.5, 0, 7, 0]).all()


def test_poses_and_hashes_are_those_without_it_to_the_bit() -> None:
    with_it, without = fall("velocity_log").run(STEPS), fall().run(STEPS)
    assert without.pose.shape == (STEPS + 1, 2, 7)
    assert with_it.pose[:, :, :7].tobytes() == without.pose.tobytes()
    assert with_it.step.tobytes() == without.step.tobytes()


@pytest.mark.parametrize("record", [True, False])
@pytest.mark.parametrize("velocities", [True, False])
def test_it_is_on_where_a_run_is_logged_with_velocities(velocities: bool, record: bool) -> None:
    cell = resolved({"ball": sphere(0.1, (0, 0, 5))})
    cell["record"]["velocities"] = velocities
    decided = planned(cell, record).decisions["velocity_log"]
    assert decided.on == (velocities and record)
    expected = f"record.velocities is {str(velocities).lower()}"
    assert decided.reason == (expected if record else "nothing of the run is logged")


def test_a_cell_without_velocities_is_written_as_by_earlier_versions() -> None:
    silent = CellRecord(residuals="none", problems="none")
    assert silent.model_dump() == {
        "residuals": "none", "problems": "none", "contacts": "all", "poses": "all",
    }  # fmt: skip
    assert CellRecord.model_validate(silent.model_dump()) == silent
