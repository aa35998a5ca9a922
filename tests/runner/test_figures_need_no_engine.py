"""Figures come from logs alone: with the kernels gone, and where numba cannot be imported."""

from __future__ import annotations

import json
from pathlib import Path

from small_configs import python, run_in_new_process, write

DRAW = """
import json, sys
from pathlib import Path
sys.modules["numba"] = sys.modules["llvmlite"] = None  # importing either fails
import lavendersim
from lavendersim.figures import draw
written = draw(lavendersim.open_run(sys.argv[1]), Path(sys.argv[2]))
print(json.dumps({
    "written": [str(path) for path in written],
    "engines": [name for name in sys.modules
                if name.startswith(("lavendersim.engine", "lavendersim.scene"))],
}))
"""
# What effects declare, keys of configs and columns of logs, stands in their files in the engine.
DECLARATIONS = {
    "lavendersim.engine",
    "lavendersim.engine.effects",
    "lavendersim.engine.records",
    "lavendersim.engine.solvers",
    "lavendersim.engine.spec",
    "lavendersim.engine.step_terms",
    "lavendersim.engine.terms",
}


def test_figures_are_drawn_without_numba_engine_or_kernels(tmp_path: Path) -> None:
    ran = run_in_new_process(write(tmp_path), tmp_path / "runs")
    empty = tmp_path / "no kernels"
    found = json.loads(
        python(DRAW, ran["run"], tmp_path / "figures", LAVENDER_CACHE_DIR=str(empty))
    )
    effects = "lavendersim.engine.effects."
    assert {name for name in found["engines"] if not name.startswith(effects)} <= DECLARATIONS
    assert {Path(path).suffix for path in found["written"]} == {".png", ".svg"}
    assert all(Path(path).stat().st_size > 1000 for path in found["written"])
    assert not empty.exists()
