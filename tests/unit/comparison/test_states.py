"""Where two logs part: to the last bit, at the first step, with the bodies and by how much."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lavendersim import open_trace
from lavendersim.comparison.states import LENGTH, NOTHING, POSES, VELOCITIES, parting
from lavendersim.trace import Block, Trace
from tests.unit.trace import sample

STEPS = 60


def logged(block: Block, path: Path) -> Trace:
    return open_trace(sample.write(path, [block]))


def quiet() -> Block:
    """A run of which every pose is finite."""
    block = sample.run(STEPS)
    pose = np.zeros_like(block.pose)
    pose[:, :, 0] = np.arange(STEPS)[:, None]
    pose[:, :, 3] = 1.0
    return block._replace(pose=pose)


@pytest.fixture
def one(tmp_path: Path) -> Trace:
    return logged(quiet(), tmp_path / "one.mcap")


def test_a_log_and_its_copy_are_equal(one: Trace, tmp_path: Path) -> None:
    found = parting(one, logged(quiet(), tmp_path / "other.mcap"))
    assert (found.differs, found.steps, found.bodies) == (NOTHING, STEPS, ())


@pytest.mark.parametrize(("body", "step"), [(1, 1), (2, 37), (1, STEPS - 1)])
def test_the_last_bit_of_a_pose_is_found(body: int, step: int, one: Trace, tmp_path: Path) -> None:
    other = quiet()
    x = other.pose[step, body, 0]
    other.pose[step, body, 0] = np.nextafter(x, np.inf)
    found = parting(one, logged(other, tmp_path / "other.mcap"))
    assert (found.differs, found.step) == (POSES, step)
    assert found.time == pytest.approx(step / 240, abs=1e-9)  # a log counts ns
    (apart,) = found.bodies
    assert (apart.body, apart.metres) == (sample.BODIES[body], np.nextafter(x, np.inf) - x)


def test_the_sign_of_zero_is_a_bit_of_the_state(one: Trace, tmp_path: Path) -> None:
    other = quiet()
    other.pose[5, 1, 1] = -0.0
    found = parting(one, logged(other, tmp_path / "other.mcap"))
    assert (found.step, found.bodies[0].metres) == (5, 0.0)


def test_velocities_part_before_poses_do(one: Trace, tmp_path: Path) -> None:
    other = quiet()
    other.step["state_hash"][9:] += np.uint64(1)
    other.pose[10:, 2, 2] += 0.25
    found = parting(one, logged(other, tmp_path / "other.mcap"))
    assert (found.differs, found.step) == (VELOCITIES, 9)
    assert found.posed == pytest.approx(10 / 240, abs=1e-9)
    assert [(apart.body, apart.metres) for apart in found.bodies] == [("crate", 0.25)]


def test_bodies_come_by_their_distance_and_the_farthest_is_that_of_the_run(
    one: Trace, tmp_path: Path
) -> None:
    other = quiet()
    other.pose[7:, 1, 2] += 0.125
    other.pose[7:, 2, 2] += 0.5
    other.pose[30, 1, 2] += 8.0
    found = parting(one, logged(other, tmp_path / "other.mcap"))
    apart = [(one.body, one.metres) for one in found.bodies]
    assert apart == [("crate", 0.5), ("ball", 0.125)]
    assert found.farthest is not None
    assert (found.farthest.body, found.farthest.metres) == ("ball", 8.125)


def test_a_shorter_log_is_another_one(one: Trace, tmp_path: Path) -> None:
    other = sample.split(quiet(), [40])[0]
    found = parting(one, logged(other, tmp_path / "other.mcap"))
    assert (found.differs, found.steps) == (LENGTH, 40)
