"""The chapter's telemetry interface and Gymnasium's conventions."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.lib.recfunctions import append_fields

import lavendersim
from lavendersim.errors import UsageError
from lavendersim.simulator import BODY_CONTACT_COLUMNS, CONTACT_COLUMNS

WEIGHT = 9.81


@pytest.fixture
def sim(drop: Path) -> lavendersim.Simulator:
    return lavendersim.Simulator(drop)


def test_step_gives_five_values_and_the_chapters_columns(sim: lavendersim.Simulator) -> None:
    ball_id, floor_id = sim.body_id("ball"), sim.body_id("floor")
    touched = 0
    for _ in range(120):
        observation, reward, terminated, truncated, info = sim.step()
        contacts = observation["collision"]["contacts"]
        assert contacts.dtype == np.float64
        assert contacts.ndim == 2
        assert contacts.shape[1] == len(CONTACT_COLUMNS) >= 9
        assert (reward, terminated) == (0.0, False)
        normal_force = sim.body_contact_data()[ball_id, 1]
        penetration = contacts[:, 8].max() if len(contacts) else 0.0
        if len(contacts):
            touched += 1
            assert contacts[0, :2].tolist() == [floor_id, ball_id]
            assert contacts[0, 5:8].tolist() == [0.0, 0.0, 1.0]
            # the ball has one contact, and F = j / dt
            assert normal_force == contacts[0, CONTACT_COLUMNS.index("force_n")]
            impulse = contacts[0, CONTACT_COLUMNS.index("impulse_n")]
            assert normal_force == pytest.approx(impulse / sim.timestep, rel=1e-15)
            assert penetration >= 0.0
        else:
            assert (normal_force, penetration) == (0.0, 0.0)
    assert touched > 0
    assert truncated, "0.5 s at 240 Hz are over"
    assert info["time"] == 0.5


def test_a_resting_ball_is_carried(sim: lavendersim.Simulator) -> None:
    # five bounces at e = 0.5 from 0.1 m are over well within 3 s
    for _ in range(720):
        sim.step()
    data = sim.body_contact_data()
    assert data.shape == (2, len(BODY_CONTACT_COLUMNS))
    # one contact and one row: the solve is exact, so only rounding is left
    assert data[:, 1] == pytest.approx([WEIGHT, WEIGHT], rel=1e-12)


@pytest.mark.parametrize("connection", ["rope", "joint"])
def test_rows_of_connections_are_no_contacts_of_bodies(
    sim: lavendersim.Simulator, connection: str
) -> None:
    for _ in range(720):
        sim.step()
    own = sim._rows.contact
    rows = append_fields(np.repeat(own, 2), connection, np.arange(2 * len(own)) % 2, usemask=False)
    before = sim.body_contact_data()
    sim._rows = sim._rows._replace(contact=rows)
    assert np.array_equal(sim.body_contact_data(), before)


def test_reset_returns_to_the_same_bits(sim: lavendersim.Simulator) -> None:
    def play() -> list[int]:
        sim.reset(seed=7)
        return [sim.step()[4]["state_hash"] for _ in range(100)]

    assert play() == play()


def test_reset_seeds_the_generator(sim: lavendersim.Simulator) -> None:
    sim.reset(seed=7)
    first = sim.np_random.random()
    sim.reset(seed=7)
    assert sim.np_random.random() == first
    sim.reset()  # no seed: the generator goes on
    assert sim.np_random.random() != first


def test_reset_gives_observation_and_info_at_time_zero(sim: lavendersim.Simulator) -> None:
    sim.step()
    observation, info = sim.reset()
    assert info["time"] == 0.0
    assert len(observation["collision"]["contacts"]) == 0
    # clearance 0.1 m above a ball of radius 0.1 m
    assert observation["bodies"]["position"][sim.body_id("ball")].tolist() == [0.0, 0.0, 0.2]


def test_a_wrong_body_name_gets_the_nearest(sim: lavendersim.Simulator) -> None:
    with pytest.raises(UsageError, match='no body is called "bal"; did you mean "ball"'):
        sim.body_id("bal")


def test_an_action_or_option_is_refused_and_not_ignored(sim: lavendersim.Simulator) -> None:
    with pytest.raises(UsageError, match="takes no action"):
        sim.step([1.0])  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="knows no options"):
        sim.reset(options={"wind": 1})


def test_divergence_terminates_and_stays_terminated(drop: Path) -> None:
    # the position overflows within a few steps at 1e308 m/s
    text = drop.read_text().replace("mass: 1.0", "mass: 1.0\n      velocity: [1.0e+308, 0, 0]")
    drop.write_text(text.replace("duration: 0.5", "duration: 10"))
    sim = lavendersim.Simulator(drop)
    for _ in range(2400):
        _, _, terminated, _, _ = sim.step()
        if terminated:
            break
    assert terminated
    with pytest.raises(UsageError, match="has diverged"):
        sim.step()


def test_stepping_gives_the_bits_of_a_logged_run(drop: Path, tmp_path: Path) -> None:
    finished = lavendersim.run(drop, tmp_path / "runs")
    hashes = finished.run.cells[0].trace().step["state_hash"].tolist()
    sim = lavendersim.Simulator(drop)
    _, info = sim.reset()
    stepped = [info["state_hash"]] + [sim.step()[4]["state_hash"] for _ in range(120)]
    assert stepped == hashes
