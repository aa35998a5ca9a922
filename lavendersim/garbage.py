"""Looking for garbage that holds itself, put off while many objects are made that all stay.

The interpreter looks through all objects each time that they have grown by a quarter. Where nothing
is to be found that takes a tenth of the time to compile, a third of the time in which this process
plans and judges a sweep, and as long as reading a text.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

# Objects made since the last look. What few parts of kernels left is in the processor's caches yet.
MANY: Final = 5000


_put_off = False  # whether it is looked for again later


@contextmanager
def uncollected() -> Iterator[None]:
    """Look for no garbage inside."""
    global _put_off
    collected = gc.isenabled()
    gc.disable()
    _put_off |= collected
    try:
        yield
    finally:
        if collected:
            _put_off = False
            gc.enable()


def collect_recent() -> None:
    """Look, where that is put off, for garbage among what was made since the last look, if much."""
    if _put_off and gc.get_count()[0] > MANY:
        gc.collect(0)
