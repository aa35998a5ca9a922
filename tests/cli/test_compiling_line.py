"""While kernels compile one line on stderr says so; `doctor` shows what is kept and deletes it."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from lavendersim.engine.compile_lock import NAME as LOCK
from tests.drop_config import DROP
from tests.forked_python import python
from tests.kept_kernels import parts_of

Command = Callable[..., subprocess.CompletedProcess[str]]


def command_in(folder: Path, kernels: Path) -> Command:
    """Return the command line, in a process of its own, in a folder and with kernels of its own."""

    def command(*arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
        kept = {"LAVENDER_CACHE_DIR": str(kernels), "NO_COLOR": "1"}
        words = ("-m", "lavender_cli.main", *arguments)
        return python(*words, where=folder, **kept | environment)

    return command


@pytest.fixture
def lavender(tmp_path: Path) -> Command:
    """The command line, with a cache that starts empty."""
    return command_in(tmp_path, tmp_path / "kernels")


class First(NamedTuple):
    """The first run of a drop: what it printed, and the cache that has all it compiled."""

    done: subprocess.CompletedProcess[str]
    kernels: Path


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> First:
    """A run whose cache was empty."""
    folder = tmp_path_factory.mktemp("first")
    (folder / "drop.yaml").write_text(DROP)
    done = command_in(folder, folder / "kernels")("run", folder / "drop.yaml")
    assert done.returncode == 0, done.stderr
    return First(done, folder / "kernels")


@pytest.fixture
def parts(first: First, tmp_path: Path) -> None:
    """Let the command line's cache begin with the parts of a drop's kernels, and no kernel."""
    parts_of(first.kernels, tmp_path / "kernels")


def test_compiling_is_announced_once_with_effects_and_place(
    first: First, drop: Path, tmp_path: Path
) -> None:
    (line,) = first.done.stderr.splitlines()
    assert line.startswith("drop: compiling kernels for ")
    for part in ("gravity", "restitution", "sphere_plane", f"(once; kept in {first.kernels})"):
        assert part in line
    assert "compiling" not in first.done.stdout
    second = command_in(tmp_path, first.kernels)("run", drop)
    assert (second.returncode, second.stderr) == (0, "")


@pytest.mark.usefixtures("parts")
def test_json_on_stdout_is_not_disturbed(lavender: Command, drop: Path) -> None:
    done = lavender("run", drop, "--json")
    assert "compiling kernels for" in done.stderr
    assert json.loads(done.stdout)[0]["run"]


@pytest.mark.usefixtures("parts")
@pytest.mark.parametrize("jobs", [1, 2])
def test_each_plan_of_a_sweep_is_announced_once(lavender: Command, drop: Path, jobs: int) -> None:
    solvers = "[projected_gauss_seidel, nonsmooth_conjugate_gradient]"
    heights = "{path: scene.bodies.ball.release.clearance, values: [0.1, 0.11]}"
    axes = f"sweep:\n  law: {{path: numerics.solver, values: {solvers}}}\n  h: {heights}\n"
    text = drop.read_text().replace("measure:\n", f"{axes}measure:\n")
    drop.write_text(text.replace("[0.02, 0.03]", "[0.02, 0.035]"))
    done = lavender("run", drop, "--jobs", jobs)
    assert done.returncode == 0, done.stderr
    # On a machine that is busy a line of progress may stand beside them.
    lines = [line for line in done.stderr.splitlines() if ": compiling " in line]
    assert len(lines) == 2
    for number, line in enumerate(lines, start=1):
        assert line.startswith(f"drop: compiling {number} of 2, solver: ")
        assert "kernels for contact_log" in line
    assert lavender("run", drop, "--jobs", jobs).stderr == ""


# A path below a file cannot be made, not even by root, for whom no directory is read-only.
def test_where_home_cannot_be_written_no_kernel_is_kept_in_a_shared_folder(
    lavender: Command, tmp_path: Path
) -> None:
    (tmp_path / "temporary").mkdir()
    (tmp_path / "blocked").write_text("")
    environment = {
        "LAVENDER_CACHE_DIR": "",
        "XDG_CACHE_HOME": str(tmp_path / "blocked"),
        "TMPDIR": str(tmp_path / "temporary"),
    }
    why = f"{tmp_path}/blocked/lavender is no directory that this user alone can write"
    note = f"{why}, LAVENDER_CACHE_DIR names another: kernels are compiled anew in every process"
    assert note in lavender("doctor", **environment).stdout
    assert list((tmp_path / "temporary").glob("lavender*")) == []


def test_without_any_place_a_run_says_that_each_compiles(
    lavender: Command, drop: Path, tmp_path: Path
) -> None:
    (tmp_path / "blocked").write_text("")
    nowhere = {"LAVENDER_CACHE_DIR": str(tmp_path / "blocked" / "below")}
    run = lavender("run", drop, **nowhere)
    assert run.returncode == 0, run.stderr
    assert "kernels are compiled anew in every process" in run.stderr
    assert "once" not in run.stderr
    shown = lavender("doctor", **nowhere).stdout
    assert "kernels are compiled anew in every process" in shown
    assert "in use         0 files" in shown


def test_doctor_tells_kernels_in_use_from_stale_ones_and_deletes_either(
    lavender: Command, first: First, tmp_path: Path
) -> None:
    kernels = tmp_path / "kernels"
    shutil.copytree(first.kernels, kernels)
    own = {file for file in kernels.iterdir() if file.name != LOCK}  # a kernel, and its parts
    size = sum(file.stat().st_size for file in own)
    stale = kernels / "01234567-89abcdef-0123456789abcdef01234567.kernel"
    stale.write_bytes(bytes(2_500_000))
    shown = lavender("doctor").stdout
    assert f"kernel cache   {kernels}" in shown
    assert f"in use         {len(own)} files, {size / 1e6:.1f} MB" in shown
    assert "stale          1 file, 2.5 MB" in shown
    assert "deleted        1 file, 2.5 MB, stale" in lavender("doctor", "--clean-stale").stdout
    assert set(kernels.iterdir()) - {kernels / LOCK} == own
    stale.write_bytes(b"")
    left = tmp_path / "runs" / "20261125T000000Z-killed-0" / ".cells.0-0.unfinished.json"
    left.parent.mkdir(parents=True)
    left.write_bytes(bytes(2_500_000))
    said = lavender("doctor", "--clean").stdout
    assert "deleted        1 file, 2.5 MB, half written in runs" in said
    assert [*left.parent.iterdir()] == []
    # The lock is empty, and whoever compiles may have it open.
    assert [file.name for file in kernels.iterdir()] == [LOCK]
