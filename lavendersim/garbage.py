"""Looking for garbage that holds itself, put off while many objects are made that all stay.

The interpreter looks through all objects each time that they have grown by a quarter. Where nothing
is to be found that takes a tenth of the time to compile, a third of the time in which this process
plans and judges a sweep, and as long as reading a text.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def uncollected() -> Iterator[None]:
    """Look for no garbage inside."""
    collected = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collected:
            gc.enable()
