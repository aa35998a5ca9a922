"""Samples of an engine in another process: numbers, or NaN where it gave none; nothing is left."""

from __future__ import annotations

import math

from lavendersim.experiment import load_experiment_text
from lavendersim.peers.timing import EngineFailed, TimingServer, TimingTask
from lavendersim.runner.timed_elsewhere import TimedElsewhere, timing_servers
from tests.engines import BALL


class Server(TimingServer):
    """Answers without a process."""

    closed = 0

    def sample(self, asked: TimingTask) -> float:
        """Give the steps as their cost, and fail from the hundredth on."""
        if asked.first >= 100:
            raise EngineFailed("hangs")
        return float(asked.steps)

    def close(self) -> None:
        """Count."""
        self.closed += 1


def test_a_sample_is_asked_of_the_server_of_the_engine_and_a_failure_is_no_number() -> None:
    text = f"{BALL}engine: mujoco-stiff\n"
    config = load_experiment_text(text, "ball.yaml").cells()[0].config
    server = Server()
    with timing_servers() as servers:
        servers["mujoco"] = server
        assert TimedElsewhere(config, 10, 20, 1000, servers).sample() == 20.0
        assert math.isnan(TimedElsewhere(config, 100, 20, 1000, servers).sample())
        assert list(servers) == ["mujoco"]
    assert server.closed == 1
