"""Shared by all tests: pytest's own test harness, a small experiment, and what is quick."""

from __future__ import annotations

import contextlib
import gc
import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis.internal.conjecture import providers

from tests.drop_config import DROP
from tests.families_of_plans import ScenesSharePlans
from tests.thorough import THOROUGH

pytest_plugins = ["pytester"]
pytest.register_assert_rewrite("tests.marked_config")

# Hypothesis also draws numbers that stand in the sources it finds loaded: any new file, and which
# tests a process ran before, would change every world that is drawn.
if hasattr(providers, "_get_local_constants"):
    providers._get_local_constants = providers.Constants

# Kernels of the suite are not optimised, where nothing else is said: that takes two fifths of the
# time of a plan, and the suite compiles hundreds, each for a few thousand steps. No bit depends on
# it (`tests/unit/engine/test_optimised_kernels.py`); `NUMBA_OPT=3 pytest` runs what users run.
os.environ.setdefault("NUMBA_OPT", "0")

ROOT = Path(__file__).parents[1]
# `pytest -m quick`: what must be seen before every commit. One claim of every layer, in at most two
# minutes on two cores with kernels cold: no more than a handful of engines are compiled.
QUICK = (
    "tests/configs",
    "tests/unit/cell",
    "tests/unit/experiment",
    "tests/unit/geometry",
    "tests/unit/measures",
    "tests/unit/scene",
    "tests/unit/test_clock.py",
    "tests/unit/trace",
    "tests/rules/test_house_keeping.py",
    "tests/rules/test_language.py",
    "tests/rules/test_recorded_columns.py",
    "tests/rules/test_unit_tests_mirror_the_source.py",
    "tests/rules/test_walls.py",
    "tests/physics/test_impulse_is_force_times_step.py",
    "configs/chapter/normal_impulse.yaml",
    "configs/chapter/impact_telemetry.yaml",
)
# Of hundreds of cells each, on one plan: what it takes to optimise it, their steps give back. And
# what was found on the engine with everything, which the fuzz compiles optimised.
OPTIMISED = [
    *(ROOT / f"configs/hard/maps/{name}.yaml" for name in ("mass_ratio", "stack_height")),
    ROOT / "configs/hard/found/cohesion_of_what_turns.yaml",
    ROOT / "configs/hard/found/springs_beside_what_gives_way.yaml",
]
# Files of tests go to whichever process is free, and the last of them decide how long the others
# wait: those come last that compile nothing or little, of which none takes a minute.
LIGHT = (
    "tests/configs",
    "tests/rules",
    *(f"tests/unit/{room}" for room in ("arrow", "cell", "comparison", "experiment", "figures")),
    *(f"tests/unit/{room}" for room in ("geometry", "measures", "quantities", "replay", "scene")),
    "tests/unit/trace",
)


def pytest_configure(config: pytest.Config) -> None:
    """Let files be handed out in the order that is made here, not by their numbers of tests.

    And let scenes share plans, but where everything is tested.
    """
    if hasattr(config.option, "loadscopereorder"):
        config.option.loadscopereorder = False
    if not THOROUGH:
        config.pluginmanager.register(ScenesSharePlans())


def pytest_collection_finish() -> None:
    """Let no collection look through twenty thousand items again, nor a fork copy them."""
    gc.collect()
    gc.freeze()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put light files last, and mark the quick tests by the place they stand in."""
    light = [ROOT / place for place in LIGHT]
    last = {path: any(map(path.is_relative_to, light)) for path in {item.path for item in items}}
    items.sort(key=lambda item: last[item.path])
    quick = [ROOT / place for place in QUICK]
    files = {item.path for item in items}  # a few hundred, of thousands of items
    marked = {file for file in files if any(map(file.is_relative_to, quick))}
    for item in items:
        if item.path in marked:
            item.add_marker(pytest.mark.quick)


@pytest.fixture
def drop(tmp_path: Path) -> Path:
    """A ball from 0.1 m at e = 0.5: the ideal apex is 0.025 m."""
    path = tmp_path / "drop.yaml"
    path.write_text(DROP)
    return path


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Run configs of many steps on optimised kernels."""
    with optimising() if item.path in OPTIMISED else contextlib.nullcontext():
        return (yield)


@contextlib.contextmanager
def optimising() -> Iterator[None]:
    """Compile as users do, here and in processes that are started: what makes millions of steps."""
    from numba import config  # late: most tests here ask for it themselves

    before = os.environ["NUMBA_OPT"]
    os.environ["NUMBA_OPT"] = "3"
    config.reload_config()
    yield
    os.environ["NUMBA_OPT"] = before
    config.reload_config()


@pytest.fixture(scope="module")
def optimised() -> Iterator[None]:
    """Compile as users do, for all tests of a file."""
    with optimising():
        yield
