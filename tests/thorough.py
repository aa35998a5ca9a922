"""Whether tests take all there is, for hours, where they else take a sample."""

from __future__ import annotations

import os
from typing import Final

THOROUGH: Final = bool(os.environ.get("LAVENDER_TEST_EVERYTHING"))
