"""The kernel cache saves time and changes nothing: not damaged, not stale, not unwritable."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from numba.core.registry import cpu_target

from lavendersim.engine import compile_options
from lavendersim.engine.kernel_cache import KernelCache
from lavendersim.engine.spec import Spec
from lavendersim.engine.step import make_advance
from tests.kept_kernels import of_scenes
from tests.runner.small_configs import RUN, copy_package, python, run_in_new_process, write


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, dict[str, Any]]:
    """A config, a cache that holds its kernel, and what the run that filled it gave."""
    folder = tmp_path_factory.mktemp("kept")
    config, kernels = write(folder), folder / "kernels"
    first = run_in_new_process(config, folder / "runs", LAVENDER_CACHE_DIR=str(kernels))
    return config, kernels, first


def test_a_compiled_and_a_loaded_kernel_give_the_same_bytes(
    kept: tuple[Path, Path, dict[str, Any]], tmp_path: Path
) -> None:
    config, kernels, compiled = kept
    written = {path: path.stat().st_mtime_ns for path in of_scenes(kernels)}
    assert len(written) == 1, "the first run was to keep its kernel"
    loaded = run_in_new_process(config, tmp_path / "runs", LAVENDER_CACHE_DIR=str(kernels))
    assert {path: path.stat().st_mtime_ns for path in of_scenes(kernels)} == written
    assert loaded["logs"] == compiled["logs"]


def test_a_kernel_with_one_flipped_bit_is_ignored_and_written_anew(
    kept: tuple[Path, Path, dict[str, Any]], tmp_path: Path
) -> None:
    config, kernels, first = kept
    (file,) = of_scenes(kernels)
    copy = tmp_path / "kernels" / file.name
    shutil.copytree(kernels, copy.parent)  # with its parts, which are sound
    damaged = bytearray(file.read_bytes())
    damaged[len(damaged) // 2] ^= 1
    copy.write_bytes(damaged)
    again = run_in_new_process(config, tmp_path / "runs", LAVENDER_CACHE_DIR=str(copy.parent))
    assert again["logs"] == first["logs"]
    assert copy.read_bytes() != damaged


def test_damaged_parts_are_compiled_anew(
    kept: tuple[Path, Path, dict[str, Any]], tmp_path: Path
) -> None:
    config, kernels, first = kept
    store = tmp_path / "kernels"
    store.mkdir()
    parts = sorted(kernels.glob("*.part"))
    for number, part in enumerate(parts):
        damaged = bytearray(part.read_bytes())
        damaged[number % len(damaged)] ^= 1
        (store / part.name).write_bytes(damaged[: len(damaged) - number % 2])
    again = run_in_new_process(config, tmp_path / "runs", LAVENDER_CACHE_DIR=str(store))
    assert again["logs"] == first["logs"]
    assert parts
    assert all((store / part.name).read_bytes() == part.read_bytes() for part in parts)


@pytest.mark.parametrize("length", [0, 16, 32, 1000], ids="first {} bytes".format)
def test_a_truncated_kernel_counts_as_absent(
    kept: tuple[Path, Path, dict[str, Any]], tmp_path: Path, length: int
) -> None:
    (file,) = of_scenes(kept[1])
    cache = KernelCache(Spec(), make_advance(Spec()))
    cache.cache_path = tmp_path
    stored = cache.path(cache.key(()))
    stored.write_bytes(file.read_bytes()[:length])
    assert cache.load_overload((), cpu_target.target_context) is None
    assert (cache.hits, cache.misses) == (0, 1)


@pytest.mark.parametrize("change", ["comment", "new file", "renamed file"])
def test_every_change_of_an_engine_source_changes_the_source_hash(
    tmp_path: Path, change: str
) -> None:
    def source_hash() -> str:
        return python(
            "from lavendersim.engine.sources import source_hash; print(source_hash())",
            PYTHONPATH=str(tmp_path),
        )

    copy_package(tmp_path)
    engine = tmp_path / "lavendersim/engine"
    before = source_hash()
    if change == "comment":
        deepest = engine / "collide/pairs/box_box.py"
        deepest.write_text(deepest.read_text() + "# a word\n")
    elif change == "new file":
        (engine / "effects/unheard_of.py").write_text("")
    else:
        (engine / "rotation.py").rename(engine / "rotations.py")
    assert source_hash() != before


# A path below a file cannot be made, not even by root, for whom no directory is read-only. That no
# shared folder takes its place: tests/cli/test_compiling_line.py.
def test_without_any_cache_directory_a_run_compiles_and_says_so(
    kept: tuple[Path, Path, dict[str, Any]], tmp_path: Path
) -> None:
    config, _, first = kept
    blocked = write(tmp_path, "a file", "blocked")
    alone = run_in_new_process(config, tmp_path / "runs", LAVENDER_CACHE_DIR=str(blocked / "below"))
    assert "compiled anew" in alone["cache"][1]
    assert alone["logs"] == first["logs"]


# Another numba may not know the option: all its kernels count references, and hand on memory array
# by array. Kernels of both kinds do not go together.
COUNTING = """
from lavendersim.engine import compile_options
del compile_options.OPTIONS["_nrt"]
from lavendersim.engine.kernel_expressions import ShortExpressions
def refuse(*_):
    raise AssertionError("a kernel without counts")
ShortExpressions.lower_expr = refuse
"""


def test_kernels_with_reference_counting_give_the_same_bits(
    kept: tuple[Path, Path, dict[str, Any]], tmp_path: Path
) -> None:
    assert "_nrt" in compile_options.OPTIONS, "this numba was to know the option"
    config, _, first = kept
    kernels = str(tmp_path / "kernels")
    said = python(COUNTING + RUN, config, tmp_path / "runs", LAVENDER_CACHE_DIR=kernels)
    assert json.loads(said.splitlines()[-1])["logs"] == first["logs"]


# A numba that lacks what `part_compiler` leans on: importing it fails, and `njit` takes its place.
WITHOUT_PARTS = """
import sys
sys.modules["lavendersim.engine.part_compiler"] = None
from lavendersim.engine import compile
assert compile.Kernel is None
"""


def test_kernels_by_plain_njit_give_the_same_bits(
    kept: tuple[Path, Path, dict[str, Any]], tmp_path: Path
) -> None:
    config, _, first = kept
    said = python(
        WITHOUT_PARTS + RUN, config, tmp_path / "runs", LAVENDER_CACHE_DIR=str(tmp_path / "kernels")
    )
    found = json.loads(said.splitlines()[-1])
    assert found["logs"] == first["logs"]
    # Symbols of its code are numbered by process: loaded beside another's it would be taken for it.
    assert "compiled anew in every process" in found["cache"][1]
    assert not (tmp_path / "kernels").exists()


def test_a_numba_that_does_not_know_the_option_gets_the_others() -> None:
    class OlderTargetOptions:
        """What a numba without the undocumented option offers."""

    options = {"fastmath": False, "nogil": True, "_nrt": False}
    assert compile_options.known(options) == options
    assert compile_options.known(options, OlderTargetOptions) == {"fastmath": False, "nogil": True}
