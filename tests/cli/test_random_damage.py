"""Whatever happens to a log, no verb has another number of it without saying so; a small sample."""

from __future__ import annotations

from pathlib import Path

import pytest
from random_damage import KINDS, counted

from tests.thorough import THOROUGH

# `python -m tests.cli.random_damage` has as many as one has time for.
FLIPS, CUTS, EXCHANGES = (12, 4, 4) if THOROUGH else (6, 2, 2)


@pytest.mark.parametrize("kind", KINDS)
def test_damage_is_reported_by_every_verb(kind: str, tmp_path: Path) -> None:
    counts = counted(kind, tmp_path / "run", FLIPS, CUTS, EXCHANGES)
    assert counts["flip"]["plot, replay: 3"] == FLIPS
    assert counts["cut"]["show: 3"] == counts["cut"]["ls: 3"] == CUTS
