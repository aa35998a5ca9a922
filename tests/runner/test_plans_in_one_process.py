"""Plans live side by side: each gives what it gives alone, and a sweep compiles each once."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from small_configs import DROPS, run_in_new_process, write

from tests.kept_kernels import of_scenes, parts_of
from tests.thorough import THOROUGH

INTEGRATORS = ("semi_implicit_euler", "midpoint")


def swept(*integrators: str) -> str:
    """Return the drops, each with every one of `integrators`; nothing is measured."""
    axis = f"sweep:\n  law: {{path: numerics.integrator, values: [{', '.join(integrators)}]}}\n"
    text = DROPS.replace("sweep:\n", axis)
    return text[: text.index("measure:\n")]


@pytest.fixture(scope="module")
def together(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """A cache that was empty, and what one process gave that ran both plans."""
    folder = tmp_path_factory.mktemp("together")
    config, kernels = write(folder, swept(*INTEGRATORS)), folder / "kernels"
    found = run_in_new_process(config, folder / "runs", LAVENDER_CACHE_DIR=str(kernels))
    assert found["statuses"] == ["complete"] * 6
    return kernels, found


# The first plan was compiled as it is alone, before there was another.
HOW = [
    (integrator, kernels)
    for integrator in INTEGRATORS
    for kernels in ("compiled", "loaded")
    if THOROUGH or (integrator, kernels) != (INTEGRATORS[0], "compiled")
]


@pytest.mark.parametrize(("integrator", "kernels"), HOW)
def test_a_plan_gives_the_same_bits_alone_as_beside_another(
    together: tuple[Path, dict[str, Any]], tmp_path: Path, integrator: str, kernels: str
) -> None:
    held, found = together
    folder = held if kernels == "loaded" else tmp_path / "kernels"
    before = set(held.iterdir())
    alone = run_in_new_process(
        write(tmp_path, swept(integrator)), tmp_path / "runs", LAVENDER_CACHE_DIR=str(folder)
    )
    cells = slice(0, 3) if integrator == INTEGRATORS[0] else slice(3, 6)
    # The hash of the last step is that of a state all earlier steps went into.
    assert alone["hashes"] == found["hashes"][cells]
    assert alone["heights"] == found["heights"][cells]
    assert set(held.iterdir()) == before


def test_the_two_plans_differ(together: tuple[Path, dict[str, Any]]) -> None:
    _, found = together
    assert len({*found["hashes"]}) > 3


def test_forty_cells_of_one_structure_share_one_kernel(
    together: tuple[Path, dict[str, Any]], tmp_path: Path
) -> None:
    values = ", ".join(f"{0.02 * step:.2f}" for step in range(40))
    text = DROPS.replace("[0.2, 0.5, 0.8]", f"[{values}]")
    text = text[: text.index("measure:\n")]
    kernels = tmp_path / "kernels"
    parts_of(together[0], kernels)
    found = run_in_new_process(
        write(tmp_path, text), tmp_path / "runs", LAVENDER_CACHE_DIR=str(kernels)
    )
    assert found["statuses"] == ["complete"] * 40
    assert len(of_scenes(kernels)) == 1
