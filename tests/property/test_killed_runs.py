"""What a kill leaves is read, recovered and verified as it should, and what follows is whole."""

from __future__ import annotations

import os
import random
from pathlib import Path

import pytest

from lavendersim.runner import executor
from tests.property.killed_runs import READ, prepared, wrong_when_read


@pytest.mark.skipif(os.name != "posix", reason="kills as POSIX does")
@pytest.mark.parametrize("name", ["shared", "long", "partly"])  # the others: `test_resume`
def test_what_a_kill_leaves_is_read_as_what_it_is(
    tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(executor, "WORTH_PROCESSES", -1.0)
    case = prepared(tmp_path, name, READ[name])
    draw = random.Random(name)
    for jobs in (1, 2):
        folder = tmp_path / f"{jobs}"
        folder.mkdir()
        how = jobs, draw.uniform(0.0, 1.2 * case.seconds), jobs == 1
        assert [*wrong_when_read(case, folder, how)] == []
