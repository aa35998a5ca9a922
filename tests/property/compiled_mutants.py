"""Mutants of the engine on compiled kernels: a copy of the package, and tests chosen for a file.

A mutant costs some 20 s. Kernels are compiled without LLVM's optimisation, which takes a third of
the time and changes no law; what the mutant leaves alone is not compiled again.
"""

from __future__ import annotations

import os
import shutil
import signal
import sys
import time
from fnmatch import fnmatch
from pathlib import Path

from tests.property.engine_mutants import ENGINE, ROOT, Mutant, applied

COPIED = ("lavendersim", "tests", "configs", "docs", "pyproject.toml")
# Tests that see most of what breaks, in this order; those of a file's own name come before them.
ANY = (
    *("tests/physics/test_impulse_is_force_times_step.py", "tests/property/test_momentum.py"),
    *("tests/property/test_energy.py", "tests/property/test_symmetries.py"),
    *("configs/scenes/rest.yaml", "configs/scenes/oblique_impact.yaml"),
    *("configs/scenes/stack_of_six.yaml", "configs/scenes/free_rotation.yaml"),
    *("configs/scenes/incline.yaml", "tests/physics/test_impacts_in_order.py"),
    *("tests/physics/test_springs_at_the_middle.py", "tests/property/test_zoo_momentum.py"),
)
OF_FILES = {
    "collide/*": ("tests/unit/engine/collide",),
    "collide/broad/*": ("tests/unit/engine/collide/broad", "configs/hard/fast/bullet.yaml"),
    "solvers/*": (
        *("tests/unit/engine/solvers", "tests/unit/problems/test_by_kernel_and_matrix.py"),
        "configs/scenes/friction_laws.yaml",
    ),
    "effects/*": ("tests/unit/engine/effects", "tests/physics/test_undetermined_forces.py"),
    "effects/hertz*": ("tests/physics/test_hertz_contacts.py",),
    "effects/tangential_c*": ("tests/physics/test_springs_along_surfaces.py",),
    "tangential_springs.py": ("tests/physics/test_springs_along_surfaces.py",),
    "effects/*spring*": ("tests/physics/test_contact_springs.py",),
    "effects/impact*": ("tests/physics/test_pairwise_impacts.py",),
    "effects/sleeping.py": ("tests/physics/test_sleeping_configs.py",),
    "effects/*motion.py": ("tests/physics/test_functions_of_time.py",),
    "effects/varying_force.py": ("tests/physics/test_functions_of_time.py",),
    "effects/time_functions.py": ("tests/physics/test_functions_of_time.py",),
    "effects/surface_velocity.py": ("tests/physics/test_moving_surfaces.py",),
    "effects/fast_bodies.py": ("tests/physics/test_fast_misses.py",),
    "effects/error_control.py": ("tests/physics/test_error_control.py",),
    "step_doubling.py": (
        "tests/physics/test_error_control.py",
        "tests/physics/test_accuracy_over_phases.py",
        "tests/physics/test_accuracy_of_joints.py",
    ),
    "error_estimate.py": (
        "tests/physics/test_error_control.py",
        "tests/physics/test_accuracy_of_joints.py",
    ),
    "hidden_bends.py": ("tests/physics/test_accuracy_of_drives.py",),
    "motor_reach.py": (
        "tests/physics/test_joint_drives.py",
        "tests/physics/test_accuracy_of_drives.py",
    ),
    "drives.py": ("tests/physics/test_functions_of_time.py",),
    "spring_midpoint.py": ("tests/physics/test_springs_at_the_middle.py",),
    "midpoint_*": ("tests/physics/test_contact_at_second_order.py",),
    "impact_*": (
        "tests/physics/test_impacts_in_order.py",
        "tests/physics/test_pairwise_impacts.py",
    ),
    "foreseen_impacts.py": ("tests/physics/test_impacts_in_order.py",),
    "integrate.py": ("tests/physics/test_divergence.py",),
    "stronge.py": ("configs/scenes/rod_end.yaml",),
}
LIMIT = 120.0  # [s] of the tests of a mutant, which may never end
FIRST = 1800.0  # [s] of all tests on what is whole, with kernels cold
UNUSED = ("-k", "not coal")  # another library's distances, which is not always there
SEEN, UNSEEN, ENDLESS, BROKEN = "seen", "unseen", "never ends", "broken"


def tests_of(file: str) -> list[str]:
    """Return the tests that are run on mutants of a file, in their order."""
    path = Path(file)
    own = [Path("tests/unit/engine") / path.parent / f"test_{path.name}"]
    own += [Path("configs/effects") / f"{path.stem}.yaml"]
    named = [one.as_posix() for one in own if (ROOT / one).exists()]
    named += [
        test for pattern, tests in OF_FILES.items() if fnmatch(file, pattern) for test in tests
    ]
    return [*dict.fromkeys([*named, *ANY])]


def copied(folder: Path) -> Path:
    """Return a copy of the package and its tests, to be broken."""
    place = folder / "copy"
    place.mkdir()
    for name in COPIED:
        path = ROOT / name
        if path.is_dir():
            shutil.copytree(path, place / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(path, place / name)
    return place


def forked(place: Path, kernels: Path, targets: list[str], said: Path, limit: float = LIMIT) -> str:
    """Run tests of a copy in a process of its own; returns the result, as long as it may take."""
    process = os.fork()
    if process == 0:
        _child(place, kernels, targets, said)
    begin = time.monotonic()
    while True:
        done, status = os.waitpid(process, os.WNOHANG)
        if done:
            code = os.waitstatus_to_exitcode(status)
            return {0: UNSEEN, 1: SEEN}.get(code, SEEN if code < 0 else BROKEN)
        if time.monotonic() - begin > limit:
            os.kill(process, signal.SIGKILL)
            os.waitpid(process, 0)
            return ENDLESS
        time.sleep(0.01)


def _child(place: Path, kernels: Path, targets: list[str], said: Path) -> None:
    code = 3
    try:
        with said.open("w") as out:
            os.dup2(out.fileno(), 1)
            os.dup2(out.fileno(), 2)
        for name in [*sys.modules]:  # of the package that is whole
            if name.partition(".")[0] in ("lavendersim", "lavender_cli", "tests"):
                del sys.modules[name]
        os.environ |= {"LAVENDER_CACHE_DIR": str(kernels), "PYTHONPATH": str(place)}
        sys.path.insert(0, str(place))
        os.chdir(place)
        import pytest

        options = ["-n", "0", "-x", "-q", "-p", "no:cacheprovider", "--tb=no"]
        code = int(pytest.main([*options, *UNUSED, *targets]))
        sys.stdout.flush()
    finally:
        os._exit(code)


def first_failure(said: str) -> str:
    """Return the test that failed first, by pytest's summary."""
    failed = [line for line in said.splitlines() if line.startswith(("FAILED ", "ERROR "))]
    return failed[0].split(" ")[1] if failed else ""


def tried(mutant: Mutant, place: Path, kernels: Path, targets: list[str]) -> tuple[str, str]:
    """Break the copy, run tests, and put it back; returns the result and which test failed."""
    path = place / ENGINE / mutant.file
    whole = path.read_text()
    path.write_text(applied(whole, mutant))
    said = place / "said"
    try:
        result = forked(place, kernels, targets, said)
        return result, first_failure(said.read_text(errors="replace"))
    finally:
        path.write_text(whole)
