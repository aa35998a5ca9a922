"""Figures come from logs alone: with the kernels gone, numba is not even imported."""

from __future__ import annotations

import json
from pathlib import Path

from small_configs import python, run_in_new_process, write

DRAW = """
import json, sys
from pathlib import Path
import lavendersim
from lavendersim.figures import draw
written = draw(lavendersim.open_run(sys.argv[1]), Path(sys.argv[2]))
print(json.dumps({
    "written": [str(path) for path in written],
    "engines": [name for name in sys.modules if name.split(".")[0] in ("numba", "llvmlite")
                or name.startswith(("lavendersim.engine", "lavendersim.scene"))],
}))
"""


def test_figures_are_drawn_without_numba_engine_or_kernels(tmp_path: Path) -> None:
    ran = run_in_new_process(write(tmp_path), tmp_path / "runs")
    empty = tmp_path / "no kernels"
    found = json.loads(
        python(DRAW, ran["run"], tmp_path / "figures", LAVENDER_CACHE_DIR=str(empty))
    )
    assert found["engines"] == []
    assert {Path(path).suffix for path in found["written"]} == {".png", ".svg"}
    assert all(Path(path).stat().st_size > 1000 for path in found["written"])
    assert not empty.exists()
