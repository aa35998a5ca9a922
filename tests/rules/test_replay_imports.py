"""The room's walls at run time: a fresh interpreter, and what it has loaded."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest


def loaded_after(statement):
    code = f"{statement}\nimport json, sys; print(json.dumps(list(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return {name.partition(".")[0] for name in json.loads(done.stdout)} | set(
        json.loads(done.stdout)
    )


def test_importing_replay_is_free_of_rerun():
    assert loaded_after("import lavendersim.replay").isdisjoint({"rerun", "numba", "matplotlib"})


@pytest.mark.parametrize("module", ["headless", "viewer", "recording"])
def test_replay_knows_no_engine(module):
    loaded = loaded_after(f"import lavendersim.replay.{module}")
    assert "rerun" in loaded
    # the engine's lists of what it has are no engine
    assert loaded.isdisjoint({"numba", "matplotlib", "mcap", "lavendersim.engine.engine"})


def test_importing_the_command_is_free_of_the_room():
    assert loaded_after("import lavender_cli.replay").isdisjoint({"rerun", "numpy", "numba"})
