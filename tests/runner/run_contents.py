"""What a run holds, to be compared with what another holds."""

from __future__ import annotations

import json
from typing import Any

from lavendersim.runner import Run
from lavendersim.runner.run_directory import RESULTS

TIMES = ("physics_us_per_step", "logging_us_per_step", "compile_s")


def contents(found: Run) -> dict[str, Any]:
    """Return all that a run holds, but for times, dates and where it is."""
    files: dict[str, Any] = {log.name: log.read_bytes() for log in found.path.glob("cells/*")}
    for name in ("cells.json", "config.yaml", "resolved.json"):
        files[name] = (found.path / name).read_bytes()
    text = (found.path / RESULTS).read_text().replace(str(found.path), "RUN")
    table = json.loads(text)
    for row in (table, *table["cells"]):
        for name in TIMES:
            row.pop(name, None)
    left = {path.name for path in found.path.iterdir()}
    return files | {RESULTS: table, "names": left - {"figures"}}
