"""How many contacts a chunk has, without decoding them: in its points, and in its columns.

A log has its contacts twice, and a group of steps is whole where both have as many.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from mcap.records import Schema

from lavendersim.trace.decode import body_of, message_class
from lavendersim.trace.index import ChunkContent
from lavendersim.trace.layout import CHANNELS
from lavendersim.trace.wire import gather

POINTS: Final = CHANNELS["/contacts"]
COLUMNS: Final = CHANNELS["/contact_columns"]


def contact_rows(content: ChunkContent, channel: int, schema: Schema) -> int:
    """Return the number of contacts in a chunk of one of the two channels."""
    offsets = content.messages[channel]["offset"].astype(np.int64)
    if channel == COLUMNS:
        messages = (_parsed(content, int(offset), schema) for offset in offsets)
        return sum(int(np.frombuffer(one.counts, "<i8").sum()) for one in messages)
    # The messages of a log differ by their points alone.
    lengths = gather(content.data, offsets + 1, 8).view("<u8")[:, 0].astype(np.int64)
    first = _parsed(content, int(offsets[0]), schema)
    return int(((lengths - lengths[0] + len(first.data)) // first.point_stride).sum())


def _parsed(content: ChunkContent, offset: int, schema: Schema) -> Any:
    message = message_class(schema.name, schema.data)()
    message.ParseFromString(body_of(content, offset))
    return message
