"""A log that claims what cannot be ends every verb with a sentence, in little memory and time.

Its checksums are right, and the index of its run knows it: only what it claims is wrong.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from damaged_runs import DRAWN, made
from strange_logs import KINDS

from tests.forked_python import python


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made(DRAWN, tmp_path_factory.mktemp("whole"))


def _done(whole: Path, kind: str, folder: Path) -> dict[str, dict[str, object]]:
    run = folder / whole.name
    shutil.copytree(whole, run)
    called = python(Path(__file__).parent / "strange_logs.py", run, whole, kind)
    assert called.returncode == 0, called.stderr[-2000:]
    found: dict[str, dict[str, object]] = json.loads(called.stdout)
    return found


def test_the_whole_run_passes_every_verb_in_that_memory(whole: Path, tmp_path: Path) -> None:
    for name, done in _done(whole, "whole", tmp_path).items():
        assert done["code"] == 0, (name, done)


@pytest.mark.parametrize("kind", KINDS)
def test_every_verb_ends_with_a_sentence(whole: Path, kind: str, tmp_path: Path) -> None:
    found = _done(whole, kind, tmp_path)
    for name, done in found.items():
        assert "Traceback" not in str(done["stderr"]), (name, done)
        assert "defect of lavender" not in str(done["stderr"]), (name, done)
        # 0 and 1: a verb that needs nothing of what is wrong
        assert done["code"] in (0, 1, 3, 5), (name, done)
        if done["code"] in (3, 5):
            assert str(done["stderr"]).strip() or str(done["stdout"]).strip(), (name, done)
    # what is wrong is found by whoever needs it
    assert any(done["code"] == 3 for done in found.values())
