"""What logs of the same form share: channels of their topics, and the chunk of the geometry."""

from __future__ import annotations

import json
import struct

import zstandard
from logs_of_samples import records
from mcap.records import Message
from sample import BODIES, run

from lavendersim.trace.forms import RULES, Form, description_chunk, form_of
from lavendersim.trace.layout import CHANNELS
from lavendersim.trace.schema import STEP_COLUMNS

BLOCK = run(3)
COLUMNS = BLOCK.step.dtype, BLOCK.contact.dtype, BLOCK.residual.dtype
ALL = frozenset(CHANNELS) - {"/velocities"}


def form(topics: frozenset[str]) -> Form:
    return form_of(tuple(BODIES), COLUMNS, topics)


def topics_of(form: Form) -> set[str]:
    return {channel.topic for stream in form.streams for channel in stream.channels}


def test_there_is_a_channel_of_every_topic_and_of_no_other() -> None:
    for without in (set(), {"/contacts", "/contact_columns"}, {"/tf"}, {"/residuals"}):
        expected = ALL - without - {"/robot_description"}  # that has a chunk of its own
        assert topics_of(form(frozenset(ALL - without))) == expected
    assert "/velocities" in topics_of(form(ALL | {"/velocities"}))


def test_every_channel_has_its_number_and_a_schema_of_its_stream() -> None:
    for stream in form(ALL | {"/velocities"}).streams:
        ids = {schema.id for schema in stream.schemas}
        for channel in stream.channels:
            assert channel.id == CHANNELS[channel.topic]
            assert channel.schema_id in ids
        kinds = [type(record).__name__ for record in records(stream.data)]
        assert kinds == ["Schema"] * len(stream.schemas) + ["Channel"] * len(stream.channels)


def test_channels_say_what_their_columns_mean() -> None:
    channels = {c.topic: c for stream in form(ALL).streams for c in stream.channels}
    meanings = {column.name: column.meaning for column in STEP_COLUMNS}
    assert channels["/step"].metadata == meanings
    contacts = channels["/contact_columns"].metadata
    assert contacts["separation"].startswith("signed distance, negative inside")
    rules = json.loads(contacts[RULES])
    assert rules.keys() <= contacts.keys()
    assert "force_n" in rules  # impulse over timestep: is stored nowhere


def test_logs_of_the_same_form_share_it() -> None:
    assert form(ALL) is form(frozenset(sorted(ALL)))
    assert form(ALL) is not form(ALL - {"/residuals"})


def test_the_geometry_is_one_cdr_string_at_time_zero() -> None:
    text = "<robot name='é'/>"
    one = description_chunk(text)
    payload = zstandard.ZstdDecompressor().decompress(one.chunk.data, one.chunk.uncompressed_size)
    *_, message = records(payload)
    assert isinstance(message, Message)
    assert (message.channel_id, message.sequence, message.log_time) == (1, 0, 0)
    head, length = message.data[:4], struct.unpack_from("<I", message.data, 4)[0]
    assert head == b"\0\1\0\0"  # CDR, little endian
    assert message.data[8 : 8 + length] == text.encode() + b"\0"
    assert len(message.data) == 8 + length
