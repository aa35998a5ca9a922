"""Saved recordings read back with rerun's own reader."""

from __future__ import annotations

from collections import defaultdict

import numpy as np
import pyarrow as pa
from rerun.chunk import RrdReader


def read(path):
    """Time-varying columns by entity: the chunks in order of time, and the static ones."""
    moving, static = defaultdict(list), defaultdict(list)
    for chunk in RrdReader(path).stream():
        batch = chunk.to_record_batch()
        (static if chunk.is_static else moving)[chunk.entity_path].append(batch)
    for batches in moving.values():
        batches.sort(key=lambda batch: batch.column(times_column(batch))[0].value)
    return moving, static


def times_column(batch):
    return batch.schema.get_field_index("sim_time")


def column(batches, name):
    return [
        row
        for batch in batches
        for row in batch.column(batch.schema.get_field_index(name)).to_pylist()
    ]


def times(batches):
    chunks = [batch.column(times_column(batch)).cast(pa.int64()).to_numpy() for batch in batches]
    return np.concatenate(chunks)
