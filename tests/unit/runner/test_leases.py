"""A cell is one worker's as long as that lives; here workers are only files."""

from __future__ import annotations

import errno
import os
import socket
from pathlib import Path

import pytest

from lavendersim.errors import UsageError
from lavendersim.runner.leases import DEAD_AFTER, Leases, alive


@pytest.fixture
def leases(tmp_path: Path) -> Leases:
    for name in ("mine", "other"):
        (tmp_path / "shards" / name).mkdir(parents=True)
    return Leases(tmp_path)


def says(into: Path, shard: str, host: str, age: float) -> None:
    """Leave what a worker leaves that touched its file so long ago [s], on a host."""
    file = into / "shards" / shard / "alive"
    file.write_text(host)
    touched = file.stat().st_mtime - age
    os.utime(file, (touched, touched))


def test_one_worker_gets_a_cell(leases: Leases, tmp_path: Path) -> None:
    with alive(tmp_path / "shards/other"):
        assert leases.take("a", "other", set())
        assert not leases.take("a", "mine", set())
        assert leases.run_by_others(["a", "b"]) == ["a"]


def test_a_dead_workers_cell_is_another_workers(leases: Leases, tmp_path: Path) -> None:
    with alive(tmp_path / "shards/other"):
        assert leases.take("a", "other", set())
    dead: set[str] = set()
    assert leases.run_by_others(["a"]) == []
    assert leases.take("a", "mine", dead)
    assert dead == {"other"}
    assert [path.name for path in (tmp_path / "leases").iterdir()] == ["a"]
    assert (tmp_path / "leases/a").read_text() == "mine"


def test_a_worker_takes_its_own_cell_again(leases: Leases, tmp_path: Path) -> None:
    with alive(tmp_path / "shards/mine"):
        assert leases.take("a", "mine", set())
        assert leases.take("a", "mine", set())


@pytest.mark.parametrize(
    ("age", "taken"), [(0.0, False), (DEAD_AFTER / 2, False), (2 * DEAD_AFTER, True)]
)
def test_on_another_machine_the_last_touch_tells(
    leases: Leases, tmp_path: Path, age: float, taken: bool
) -> None:
    assert leases.take("a", "other", set())
    says(tmp_path, "other", f"not-{socket.gethostname()}", age)
    assert leases.take("a", "mine", set()) == taken


def test_where_files_cannot_be_locked_the_last_touch_tells(
    leases: Leases, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def none(*_: object) -> None:
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr("fcntl.flock", none)
    with alive(tmp_path / "shards/other"):
        assert leases.take("a", "other", set())
        assert not leases.take("a", "mine", set())
    says(tmp_path, "other", socket.gethostname(), 2 * DEAD_AFTER)
    assert leases.take("a", "mine", set())


def test_a_lease_without_a_name_is_being_made(leases: Leases, tmp_path: Path) -> None:
    """Until it has been so for too long: its worker was killed between two calls."""
    lease = tmp_path / "leases/a"
    lease.touch()
    assert not leases.take("a", "mine", set())
    old = lease.stat().st_mtime - 2 * DEAD_AFTER
    os.utime(lease, (old, old))
    assert leases.take("a", "mine", set())


def test_a_shard_has_one_worker_at_a_time(leases: Leases, tmp_path: Path) -> None:
    said = "another process runs its cells"
    with alive(tmp_path / "shards/mine"), pytest.raises(UsageError, match=said):
        alive(tmp_path / "shards/mine").__enter__()
    with alive(tmp_path / "shards/mine"):
        pass


def test_who_takes_a_dead_ones_place_meanwhile_keeps_it(
    leases: Leases, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert leases.take("a", "other", set())
    (tmp_path / "shards/third").mkdir()
    rename = os.rename

    def late(source: Path, target: Path) -> None:
        monkeypatch.undo()
        assert leases.take("a", "third", set())
        rename(source, target)

    monkeypatch.setattr(os, "rename", late)
    with alive(tmp_path / "shards/third"):
        assert not leases.take("a", "mine", set())
    assert (tmp_path / "leases/a").read_text() == "third"
