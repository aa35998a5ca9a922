"""Lets the tests of the figures, and of their panels, import the synthetic logs and pages."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent / "measures")]
