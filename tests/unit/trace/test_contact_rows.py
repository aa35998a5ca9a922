"""How many contacts a chunk has, by its bytes alone: as many as were written of its steps."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from logs_of_samples import logged
from sample import moving

from lavendersim.trace.contact_rows import COLUMNS, POINTS, contact_rows

STEPS = 1200  # several chunks of each


@pytest.mark.parametrize(
    ("topic", "channel"), [("/contacts", POINTS), ("/contact_columns", COLUMNS)]
)
def test_chunks_have_the_contacts_of_their_steps(tmp_path: Path, topic: str, channel: int) -> None:
    log = logged(tmp_path / "a.mcap", STEPS)
    schema = log.index.schemas[log.index.channels[channel].schema_id]
    times = log.block.step["time_ns"][
        np.searchsorted(log.block.step["step"], log.block.contact["step"])
    ]
    found, chunks = 0, 0
    for entry, content in log.chunks(topic):
        count = contact_rows(content, channel, schema)
        inside = (times >= entry.message_start_time) & (times <= entry.message_end_time)
        if topic == "/contacts":
            assert count == int(inside.sum())
        found, chunks = found + count, chunks + 1
    assert found == len(log.block.contact)
    assert chunks > 1


def test_steps_without_a_contact_are_messages_with_no_row(tmp_path: Path) -> None:
    block = moving(40)
    log = logged(tmp_path / "a.mcap", block=block._replace(contact=block.contact[80:]))
    schema = log.index.schemas[log.index.channels[POINTS].schema_id]
    ((_, content),) = log.chunks("/contacts")
    assert contact_rows(content, POINTS, schema) == 80  # of 160: steps 0 to 19 have none
