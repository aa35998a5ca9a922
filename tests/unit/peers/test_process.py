"""An engine that crashes or hangs is an end that is reported."""

from __future__ import annotations

from pathlib import Path

import pytest

from lavendersim.peers.messages import Ended, Task
from lavendersim.peers.process import messages_of

ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize(
    ("how", "reported"),
    [
        ("crash", "crashed: its process was ended by SIGSEGV"),
        ("exit", "crashed: its process exited with 3 (it is out of memory)"),
        ("hang", "hangs: no step was done in 3 s"),
    ],
)
def test_how_a_process_goes_wrong_is_its_end(
    how: str, reported: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    # a process that crashes must have started within the silence, on a loaded machine too
    silence = 3.0 if how == "hang" else 60.0
    found = list(messages_of(Task("", how, {}), silence, "tests.unit.peers.crashing_engine"))
    assert found == [Ended(reported)]
