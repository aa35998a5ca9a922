"""What is printed to a reader that has gone is lost, and the work goes on."""

from __future__ import annotations

import io
import os

from lavendersim.runner.unread_output import Unread


def test_a_reader_that_is_there_gets_everything() -> None:
    stream = io.StringIO()
    out = Unread(stream)
    assert out.write("text") == 4
    out.flush()
    assert stream.getvalue() == "text"
    assert out.isatty() is False  # all else is the stream's own


def test_a_reader_that_has_gone_stops_nothing() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "w", buffering=1) as stream:
        out = Unread(stream)
        assert out.write("lost\n") == 5
        assert out.write("lost, too\n") == 10
        out.flush()
    # The file is what it was opened as no more: writing goes nowhere, without an error.


def test_a_buffer_that_is_flushed_too_late_stops_nothing() -> None:
    reading, writing = os.pipe()
    stream = os.fdopen(writing, "w")
    out = Unread(stream)
    out.write("kept in the buffer")
    os.close(reading)
    out.flush()
    out.flush()
    stream.close()
