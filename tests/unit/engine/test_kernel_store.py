"""The store of kernels stays within its limit, apart by settings, and whole under two writers."""

from __future__ import annotations

import errno
import json
import math
import os
import subprocess
import sys
from pathlib import Path

import pytest

from lavendersim import durable_files
from lavendersim.engine import compile_options, kernel_store
from lavendersim.engine.compile import inner
from lavendersim.engine.compile_lock import NAME
from lavendersim.engine.kernel_cache import KernelCache
from lavendersim.engine.kernel_store import kept_kernels
from lavendersim.engine.spec import Spec
from tests.kept_kernels import of_scenes
from tests.runner.small_configs import RUN, python, run_in_new_process, write


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty directory of kernels, in this process."""
    monkeypatch.setattr(kernel_store, "directory", lambda: (tmp_path, ""))
    return tmp_path


def keep(name: str) -> KernelCache:
    """Compile a small kernel or load it, as the plan `name`."""

    def twice(x):
        return 2 * x

    kernel = inner(twice)
    kernel._cache = KernelCache(Spec(effects=(name,)), kernel)
    assert kernel(21) == 42
    return kernel._cache


def names_in(store: Path) -> set[str]:
    return {path.name.split("-")[0] for path in store.iterdir() if path.name != NAME}


def test_a_kernel_on_disk_is_known_among_others_whatever_its_arguments(store: Path) -> None:
    kept = keep("kept")
    assert kept.is_of(kernel_store.kernels_on_disk())
    other = KernelCache(Spec(effects=("other",)), kept.kernel)
    assert not other.is_of(kernel_store.kernels_on_disk())
    for path in store.glob("*.kernel"):
        path.rename(path.with_suffix(".part"))
    assert kernel_store.kernels_on_disk() == set()


def test_the_directory_is_listed_again_where_it_has_changed(
    store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    listed: list[Path] = []
    names = os.listdir
    monkeypatch.setattr(os, "listdir", lambda path: listed.append(path) or names(path))
    long_ago = 1_000_000_000
    os.utime(store, (long_ago, long_ago))
    assert [kernel_store.kernels_on_disk() for _ in range(2)] == [set(), set()]
    assert len(listed) == 1
    (store / "plan-build-kernel-key.kernel").touch()
    # A second one may follow within one tick of the clock.
    assert [kernel_store.kernels_on_disk() for _ in range(2)] == [{"plan-build-kernel"}] * 2
    assert len(listed) == 3


def test_the_kernel_not_used_for_longest_makes_room(
    store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    digests = [keep(name).spec.digest() for name in ("first", "second")]
    sizes = [kept.size for kept in kept_kernels()]
    for path in store.glob("*.kernel"):  # both were used long ago, the first one before the second
        day = digests.index(path.name.split("-")[0])
        os.utime(path, ns=(day, path.stat().st_mtime_ns))
    assert (keep("first").hits, keep("first").misses) == (1, 0)
    # Three kernels of one function differ by a few bytes of their names; two fit, three do not.
    monkeypatch.setattr(kernel_store, "LIMIT", int(2.5 * max(sizes)))
    third = keep("third").spec.digest()
    assert names_in(store) == {digests[0], third}


@pytest.mark.skipif(os.name != "posix", reason="owners and links of POSIX")
@pytest.mark.parametrize("how", ["a link", "others may write", "another's", "a file"])
def test_kernels_are_loaded_from_a_directory_of_this_user_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, how: str
) -> None:
    """What is loaded is run: somebody else's directory, made first, is not believed."""
    private, asked = tmp_path / "private", tmp_path / "asked"
    private.mkdir(mode=0o700)
    monkeypatch.setenv(kernel_store.DIRECTORY_VARIABLE, str(private))
    assert kernel_store._place.__wrapped__() == (private, "")
    monkeypatch.setenv(kernel_store.DIRECTORY_VARIABLE, str(asked))
    if how == "a link":
        asked.symlink_to(private)
    elif how == "a file":
        asked.touch()
    else:
        asked.mkdir()
        asked.chmod(0o777 if how == "others may write" else 0o700)
    if how == "another's":
        monkeypatch.setattr(os, "getuid", lambda: asked.stat().st_uid + 1)
    place, why = kernel_store._place.__wrapped__()
    assert place == Path()
    assert why.startswith(f"{asked} is no directory that this user alone can write")


def test_everything_stays_while_it_fits(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    digests = {keep(name).spec.digest() for name in ("first", "second")}
    total = sum(kept.size for kept in kept_kernels())
    monkeypatch.setattr(kernel_store, "LIMIT", total)
    kernel_store.make_room()
    assert names_in(store) == digests
    monkeypatch.setattr(kernel_store, "LIMIT", total - 1)
    kernel_store.make_room()
    assert len(names_in(store)) == 1


def test_room_is_looked_for_at_the_first_and_after_each_hundredth_of_the_limit(
    store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    written = []
    monkeypatch.setattr(kernel_store, "_unseen", math.inf)  # as a process begins
    monkeypatch.setattr(kernel_store, "LIMIT", 1000)
    monkeypatch.setattr(kernel_store, "make_room", lambda: written.append(len([*store.iterdir()])))
    for number, size in enumerate([10, 6, 4, 1, 3]):
        kernel_store.write(store / f"{number}.part", bytes(size))
    assert written == [1, 4]  # 6 + 4 is a hundredth, 1 more is above it


def test_kernels_of_other_builds_are_distinguished(
    store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    keep("ours")
    with monkeypatch.context() as other:
        other.setattr(compile_options, "_compiler_hash", lambda: "another compiler")
        keep("theirs")
    stale = {kept.path.name.split("-")[0] for kept in kept_kernels() if not kept.current}
    assert stale == {Spec(effects=("theirs",)).digest()}
    assert len(kept_kernels()) == 2


BUILD = "from lavendersim.engine.compile_options import build; print(build())"


def test_each_setting_of_numba_has_kernels_of_its_own() -> None:
    settings = [
        {},
        {"NUMBA_OPT": "1"},
        {"NUMBA_BOUNDSCHECK": "1"},
        {"NUMBA_CPU_NAME": "generic"},
        {"NUMBA_CPU_FEATURES": "+sse2"},
        {"NUMBA_ENABLE_AVX": "0"},
        {"NUMBA_LOOP_VECTORIZE": "0"},
    ]
    builds = [python(BUILD, **setting) for setting in settings]
    assert len(set(builds)) == len(settings)
    assert python(BUILD) == builds[0]


def test_numbas_settings_file_counts_as_well(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = python(BUILD)
    (tmp_path / ".numba_config.yaml").write_text("boundscheck: 1\n")
    monkeypatch.chdir(tmp_path)
    assert python(BUILD) != before


def test_two_processes_may_write_the_same_kernel_at_once(tmp_path: Path) -> None:
    config, kernels = write(tmp_path), tmp_path / "kernels"
    environment = os.environ | {"LAVENDER_CACHE_DIR": str(kernels)}
    both = [
        subprocess.Popen(
            [sys.executable, "-P", "-c", RUN, str(config), str(tmp_path / root)],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        for root in ("one", "other")
    ]
    ended = [process.communicate(timeout=120) for process in both]
    assert [process.returncode for process in both] == [0, 0], ended
    logs = [json.loads(out.splitlines()[-1])["logs"] for out, _ in ended]
    assert not list(kernels.glob("*unfinished*"))
    (file,) = of_scenes(kernels)
    written = file.stat().st_mtime_ns
    third = run_in_new_process(config, tmp_path / "third", LAVENDER_CACHE_DIR=str(kernels))
    assert logs == [third["logs"]] * 2
    assert file.stat().st_mtime_ns == written


def test_a_store_that_vanishes_costs_time_and_nothing_else(
    store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A disk that is taken away, then one that others put in its place."""
    monkeypatch.setattr(kernel_store, "write", lambda path, payload: None)
    store.rename(store.with_name("elsewhere"))
    assert keep("first").misses == 1
    assert kept_kernels() == []
    store.write_text("no directory")
    assert keep("second").misses == 1
    assert kept_kernels() == []


@pytest.mark.skipif(os.name != "posix", reason="owners of POSIX")
def test_a_kernel_that_somebody_else_wrote_is_not_loaded(
    store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The directory was this user's when the process began, and may have been made again since."""
    keep("plan")
    assert keep("plan").hits == 1
    ours = os.getuid()
    monkeypatch.setattr(os, "getuid", lambda: ours + 1)
    assert keep("plan").hits == 0


@pytest.mark.parametrize("error", [errno.ENOSPC, errno.EROFS, errno.EIO])
def test_a_store_that_cannot_be_written_costs_time_and_nothing_else(
    store: Path, monkeypatch: pytest.MonkeyPatch, error: int
) -> None:
    def fails(*_: object, **__: object) -> None:
        raise OSError(error, os.strerror(error))

    keep("earlier")
    with monkeypatch.context() as patch:
        patch.setattr(durable_files, "_write", fails)
        patch.setattr(Path, "unlink", fails)
        patch.setattr(os, "utime", fails)
        patch.setattr(kernel_store, "LIMIT", 0)
        assert (keep("earlier").hits, keep("later").misses) == (1, 1)
    assert names_in(store) == {Spec(effects=("earlier",)).digest()}
