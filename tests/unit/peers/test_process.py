"""An engine that crashes or hangs is an end that is reported."""

from __future__ import annotations

from pathlib import Path

import pytest

from lavendersim.peers.messages import Ended, Task
from lavendersim.peers.process import messages_of

ENGINE = "tests.unit.peers.crashing_engine"


@pytest.mark.parametrize(
    ("how", "reported"),
    [
        ("crash", "crashed: its process was ended by SIGSEGV"),
        ("exit", "crashed: its process exited with 3 (it is out of memory)"),
        ("hang", "hangs: no step was done in 3 s"),
        ("compute", "takes too long: no step was done in 1 s of the processor"),
    ],
)
def test_how_a_process_goes_wrong_is_its_end(how: str, reported: str) -> None:
    # a process that crashes must have started within the silence, on a loaded machine too
    silence = {"hang": 3.0, "compute": 1.0}.get(how, 60.0)
    found = list(messages_of(Task("", how, {}), silence, ENGINE))
    assert found == [Ended(reported)]


def test_what_an_engine_writes_is_not_left_where_the_run_was_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nor does it import what lies there: a script may be called as an engine's module is."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pickle.py").write_text("raise RuntimeError('not the library')")
    found = list(messages_of(Task("", "write", {}), 60.0, ENGINE))
    assert found == [Ended("crashed: its process exited with 3")]
    assert [path.name for path in tmp_path.iterdir()] == ["pickle.py"]
