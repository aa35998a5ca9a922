"""Lets the tests of the kinds import the synthetic logs, also where they run alone."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
