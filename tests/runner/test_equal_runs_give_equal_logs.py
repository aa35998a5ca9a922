"""Equal configs give equal bytes, in one process or in several."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path

import pytest
from small_configs import DROPS, write

import lavendersim
from lavendersim.runner import Finished, call_length


def logs(finished: Finished) -> dict[str, str]:
    """Return the sha256 of every log of a run, by its name."""
    return {
        cell.path.name: sha256(cell.path.read_bytes()).hexdigest() for cell in finished.run.cells
    }


@pytest.fixture(scope="module")
def once(tmp_path_factory: pytest.TempPathFactory) -> Finished:
    folder = tmp_path_factory.mktemp("once")
    return lavendersim.run(write(folder), root=folder / "runs")


def test_the_same_config_twice_gives_the_same_bytes(once: Finished, tmp_path: Path) -> None:
    again = lavendersim.run(write(tmp_path), root=tmp_path / "elsewhere")
    assert logs(again) == logs(once)
    assert again.good


def test_two_processes_give_the_same_bytes_as_one(once: Finished, tmp_path: Path) -> None:
    pooled = lavendersim.run(write(tmp_path), root=tmp_path, jobs=2)
    assert logs(pooled) == logs(once)
    assert [cell.label for cell in pooled.run.cells] == [cell.label for cell in once.run.cells]


@pytest.mark.parametrize("seconds", [1e-9, 1e3])
def test_the_length_of_calls_is_in_no_byte(
    seconds: float, once: Finished, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(call_length, "CALL", seconds)
    assert logs(lavendersim.run(write(tmp_path), root=tmp_path)) == logs(once)


def test_cells_differ_from_each_other(once: Finished) -> None:
    assert len(set(logs(once).values())) == len(once.run.cells) == 3


def test_another_value_gives_another_log(once: Finished, tmp_path: Path) -> None:
    nudged = DROPS.replace("[0.2, 0.5, 0.8]", "[0.2, 0.5, 0.8000000000000002]")
    other = lavendersim.run(write(tmp_path, nudged), root=tmp_path)
    assert not set(logs(other)) >= set(logs(once))
