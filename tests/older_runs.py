"""Runs as versions before digests left them."""

from __future__ import annotations

import json
from pathlib import Path


def without_digests(run: Path) -> Path:
    """Take the digests out of the index and the seal of a finished run; returns it."""
    index = json.loads((run / "cells.json").read_text())
    for row in index["cells"]:
        del row["config"], row["log"]
    (run / "cells.json").write_text(json.dumps(index))
    (run / "DONE").write_text("")
    return run
