"""What a fresh Python has loaded: the light doors stay light, whatever stands behind them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from sources import files, module_of, room_of

from lavendersim.engine.effects import NAMES

# Lists of what the engine has, which configs are read with.
DECLARATIONS = {
    *("lavendersim.engine", "lavendersim.engine.solvers"),
    *("lavendersim.engine.records", "lavendersim.engine.spec", "lavendersim.engine.effects"),
    *("lavendersim.engine.terms", "lavendersim.engine.step_terms"),
    *(
        f"lavendersim.engine.effects.{part}"
        for part in ("decision", "effect", "joint_models", "keys", "time_functions")
    ),
    *(f"lavendersim.engine.effects.{name}" for name in NAMES),
}
HEAVY = {"numba", "llvmlite", "matplotlib", "rerun", "numpy", "scipy", "h5py"}
VERSION = """
from lavender_cli.main import main
sys.argv = ["lavender", "--version"]
try:
    main()
except SystemExit as done:
    assert not done.code, done.code
"""


def loaded_after(code: str) -> set[str]:
    """Return every module a fresh process has loaded after running some code."""
    report = "\nprint(json.dumps(sorted(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", f"import json, sys\n{code}{report}"],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return set(json.loads(done.stdout.splitlines()[-1]))


def of_the_engine(loaded: set[str]) -> set[str]:
    """Return the modules of the engine among those that were loaded."""
    return {name for name in loaded if name.startswith("lavendersim.engine")}


@pytest.mark.parametrize("code", ["import lavendersim", VERSION], ids=["import", "--version"])
def test_the_front_doors_load_nothing_heavy(code: str) -> None:
    assert loaded_after(code) & HEAVY == set()


def test_reading_an_experiment_loads_no_kernel() -> None:
    loaded = loaded_after("from lavendersim import load_experiment")
    assert loaded & (HEAVY | {"mcap", "lavendersim.scene"}) == set()
    assert of_the_engine(loaded) <= DECLARATIONS


def test_reading_a_problem_loads_no_numba() -> None:
    loaded = loaded_after(
        "from pathlib import Path\n"
        "from lavendersim.errors import ProblemError\n"
        "from lavendersim.problems.read import read_problem\n"
        f"try:\n    read_problem(Path({__file__!r}))\nexcept ProblemError:\n    pass"
    )
    assert "lavendersim.problems.siconos" in loaded
    assert loaded & {"numba", "llvmlite", "matplotlib", "rerun"} == set()


@pytest.mark.parametrize("room", ["trace", "measures", "figures", "replay"])
def test_no_module_of_a_view_loads_the_engine(room: str) -> None:
    names = [".".join(module_of(file)) for file in files() if room_of(file) == room]
    assert names
    loaded = loaded_after("\n".join(f"import {name.removesuffix('.__init__')}" for name in names))
    assert f"lavendersim.{room}" in loaded
    assert loaded & {"numba", "llvmlite", "lavendersim.scene"} == set()
    assert of_the_engine(loaded) <= DECLARATIONS


def test_listing_runs_reads_no_config_and_no_log(tmp_path: Path) -> None:
    loaded = loaded_after(
        "from lavender_cli.main import main\n"
        f"sys.argv = ['lavender', 'ls', '--json', '--runs', {str(tmp_path)!r}]\n"
        "try:\n    main()\nexcept SystemExit as done:\n    assert not done.code, done.code"
    )
    assert "lavendersim.runner.run_directory" in loaded
    assert loaded & (HEAVY | {"mcap", "rich"}) == set()
    assert {name for name in loaded if name.startswith("lavendersim.")} == {
        *("lavendersim.errors", "lavendersim.durable_files", "lavendersim.runner"),
        "lavendersim.config_options",  # a record of four fields
        *("lavendersim.runner.listing", "lavendersim.runner.run_directory"),
        "lavendersim.runner.cells_index",
        *(f"lavendersim.runner.run_{part}" for part in ("index", "seal", "tables")),
    }


def test_a_command_ends_without_looking_for_circles() -> None:
    said = "print(json.dumps([gc.isenabled(), gc.get_freeze_count() > 10_000]))"
    code = f"import atexit, gc, json, sys\natexit.register(lambda: {said})\n{VERSION}"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True
    )
    assert json.loads(done.stdout.splitlines()[-1]) == [False, True]


# Large pages; threads of its linear algebra, each of which waits for work in a loop.
@pytest.mark.parametrize(
    ("name", "chosen", "expected"),
    [
        ("NUMPY_MADVISE_HUGEPAGE", None, "0"),
        ("NUMPY_MADVISE_HUGEPAGE", "1", "1"),
        ("OPENBLAS_NUM_THREADS", None, "1"),
        ("OPENBLAS_NUM_THREADS", "2", "2"),
    ],
)
def test_numpy_asks_for_little_unless_someone_else_says_so(
    name: str, chosen: str | None, expected: str
) -> None:
    others = {key: value for key, value in os.environ.items() if key != name}
    done = subprocess.run(
        [sys.executable, "-c", f"import lavender_cli.main, os; print(os.environ[{name!r}])"],
        env=others | ({} if chosen is None else {name: chosen}),
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    assert done.stdout.strip() == expected
