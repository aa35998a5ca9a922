"""Scratch arrays, kept by thread and name: asking for new pages takes longer than filling them."""

from __future__ import annotations

import math
import threading
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

_of_thread = threading.local()


def scratch(name: str, shape: tuple[int, ...], kind: DTypeLike) -> NDArray[Any]:
    """Return an array of this thread's own, with any content.

    It is the caller's until the same thread asks for the same name again.
    """
    size = math.prod(shape) * np.dtype(kind).itemsize
    kept: dict[str, NDArray[np.uint8]] = _of_thread.__dict__
    memory = kept.get(name)
    if memory is None or len(memory) < size:
        memory = kept[name] = np.empty(size, np.uint8)
    found: NDArray[Any] = memory[:size].view(kind).reshape(shape)
    return found
