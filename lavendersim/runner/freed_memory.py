"""Memory that a cell frees is kept for the next one.

Each cell takes the same few megabytes and gives them back. The C library hands them on to the
system, which zeroes and maps every page anew: a tenth of the time of a stack's cell, and more of it
while another process does the same.
"""

from __future__ import annotations

import ctypes
from functools import cache
from typing import Final

M_TRIM_THRESHOLD: Final = -1  # of glibc's mallopt
M_MMAP_THRESHOLD: Final = -3
# The most that glibc would set itself, which follows the largest array that was freed [byte].
OWN_PAGES: Final = 32 * 1024 * 1024  # arrays of this size have pages of their own, and return them
KEPT: Final = 2 * OWN_PAGES  # free memory that stays at the end of the heap


@cache
def keep_freed_memory() -> None:
    """Keep it in this process from now on; nothing is done where the C library is not glibc."""
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError, TypeError):  # musl and macOS have none, Windows no CDLL(None)
        return
    mallopt(M_TRIM_THRESHOLD, KEPT)
    mallopt(M_MMAP_THRESHOLD, OWN_PAGES)
