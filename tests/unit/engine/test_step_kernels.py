"""What an engine is said to be composed of is what is compiled, every time it is asked."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lavendersim.engine import compile as compiler
from lavendersim.engine.kernel_parts import STORE
from lavendersim.engine.spec import Spec
from lavendersim.engine.step import kernels_of, make_advance
from lavendersim.experiment import load_experiment
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of_cell

CONFIGS = Path(__file__).parents[3] / "configs"
ENGINE = "lavendersim.engine."
# One without friction that stops at a tolerance, one with it; one without, that records its sweeps.
NAMES = ("scenes/drop", "scenes/incline", "chapter/warm_start")


@pytest.mark.parametrize("name", NAMES)
def test_every_composed_kernel_is_compiled_and_no_other(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A kernel that is not linked was never called by another: dead weight in the plan."""
    cell = load_experiment(CONFIGS / f"{name}.yaml").cells()[0]
    spec = plan_of_cell(cell).spec
    engine = build(cell.config, spec).engine(spec)
    # A spec that no other test has: kernels that are made once a spec are made here.
    spec = spec._replace(effects=(*spec.effects, "nothing"))
    made: list[tuple[str, Any]] = []
    inner = compiler.inner

    def recording(function: Callable[..., Any]) -> Any:
        kernel = inner(function)
        module = function.__module__.removeprefix(ENGINE)
        made.append((f"{module}.{function.__name__}", kernel))
        return kernel

    monkeypatch.setattr(compiler, "inner", recording)
    engine._kernel, engine._entry = make_advance(spec), None
    monkeypatch.undo()
    STORE.begin(anew=True)  # what a part calls is not looked at where the part is there already
    engine.advance(0)
    STORE.begin(anew=False)
    compiled = {name for name, kernel in made if kernel.linked or kernel.overloads}
    composed = {f"{module}.{name}" for module, names in kernels_of(spec).items() for name in names}
    assert compiled == composed


def test_asking_twice_gives_the_same_answer() -> None:
    """Kernels that are made once a spec are listed each time."""
    spec = Spec(shape_pairs=("box_box", "hull_hull"), effects=("gravity", "nothing at all"))
    first = kernels_of(spec)
    assert "collide.convex.gjk" in first
    assert kernels_of(spec) == first
