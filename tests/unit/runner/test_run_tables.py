"""Tables of a run are read whole or refused; those of older runs get their present names."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from lavendersim.errors import TraceError
from lavendersim.runner.run_tables import FORMER_NAMES, read_table, renamed


def written(folder: Path, text: str) -> Path:
    """Write a table."""
    path = folder / "results.json"
    path.write_text(text)
    return path


def test_a_table_comes_as_it_was_written(tmp_path: Path) -> None:
    table = {"cells": [{"status": "complete", "more": 1}], "passed": True}
    path = written(tmp_path, json.dumps(table))
    assert read_table(path, "cells", ["status"]) == table


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        '{"cells": {}}',
        '{"cells": [1]}',
        '{"cells": [{"other": 1}]}',
        '{"rows": []}',
        "[" * 100_000,
    ],
)
def test_what_is_no_such_table_is_damaged(tmp_path: Path, text: str) -> None:
    with pytest.raises(TraceError, match=r"results\.json: damaged"):
        read_table(written(tmp_path, text), "cells", ["status"])


def test_columns_of_older_runs_have_their_present_names_wherever_they_stand() -> None:
    former = {now: then for then, now in FORMER_NAMES.items()}
    cost = {former["overhead"]: 1.0, former["required"]: True}
    older: dict[str, Any] = {
        "cells": [{former["not_converged_steps"]: 3}],
        former["overheads"]: {"rows": [cost]},
    }
    assert renamed(older, "cells") == {
        "cells": [{"not_converged_steps": 3}],
        "overheads": {"rows": [{"overhead": 1.0, "required": True}]},
    }
    assert not FORMER_NAMES.keys() & set(FORMER_NAMES.values())


def test_a_table_of_now_stays() -> None:
    table = {"cells": [{"status": "complete"}], "overheads": None, "truth": None}
    assert renamed(json.loads(json.dumps(table)), "cells") == table
