"""Runs as older versions left them: before digests, before residuals, and of other keys."""

from __future__ import annotations

import json
from pathlib import Path

from lavendersim.runner.results import VIOLATIONS


def without_digests(run: Path) -> Path:
    """Take the digests out of the index and the seal of a finished run; returns it."""
    index = json.loads((run / "cells.json").read_text())
    for row in index["cells"]:
        del row["config"], row["log"]
    (run / "cells.json").write_text(json.dumps(index))
    (run / "DONE").write_text("")
    return run


def of_other_keys(run: Path) -> Path:
    """Let a finished run be of a config that has a key which there is no more; returns it."""
    without_digests(run)
    index = json.loads((run / "cells.json").read_text())
    for row in index["cells"]:
        del row["coordinates"]  # nor had the index of the first versions
    (run / "cells.json").write_text(json.dumps(index))
    config = run / "config.yaml"
    config.write_text("former: 3\n" + config.read_text())
    return run


def without_residuals(run: Path) -> Path:
    """Leave of a finished run's results what the first versions wrote; returns it."""
    without_digests(run)
    results = json.loads((run / "results.json").read_text())
    for key in ("compile_s", "reduced", "solver"):
        del results[key]
    for row in results["cells"]:
        for key in ("tolerance", "worst_residual", "not_converged_steps", *VIOLATIONS):
            del row[key]
    for check in results["checks"]:
        for key in ("follows", "margin"):
            del check[key]
    (run / "results.json").write_text(json.dumps(results))
    return run
