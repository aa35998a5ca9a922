"""A process that times an engine which crashes, ends, refuses or hangs by the variant asked for."""

from __future__ import annotations

import os
import signal
import time

from lavendersim.peers import timing
from lavendersim.peers.timing import TimingTask


def sample_of(asked: TimingTask) -> float:
    """Go wrong as the name of the variant says."""
    engine = asked.task.engine
    with open("ENGINE_LOG.TXT", "a") as file:
        file.write("what an engine leaves where it works")
    if engine == "mujoco-stiff":
        os.kill(os.getpid(), signal.SIGSEGV)
    if engine == "mujoco-rk4":
        os._exit(3)
    if engine == "mujoco-cg":
        raise ValueError("it has no such shape")
    if engine == "mujoco-discrete":
        time.sleep(60.0)
    return 7.0


if __name__ == "__main__":
    timing.sample_of = sample_of
    timing.import_module = lambda name: None  # type: ignore[assignment,return-value]
    timing.main()
