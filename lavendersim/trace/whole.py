"""Whether a log was closed, and is as it was written to the byte: by CRC-32 and SHA-256.

    magic  Header  records ...  DataEnd  summary ...  Footer  magic
    `---- CRC of DataEnd -----'          `- CRC of Footer -'

What no CRC covers (DataEnd's own, the magics' ends) must be the one thing that can stand there, so
not a bit of a log can change unnoticed, nor can a chunk stand in another's place. That it is the
log that was written, and not another that is whole, says the digest that the index of its run has.
CRC and SHA-256 read more than a GB/s, many times what decompressing and decoding take. No numpy
here: runs are listed without.
"""

from __future__ import annotations

import hashlib
import struct
from pathlib import Path
from typing import BinaryIO, Final, NamedTuple

from zlib_ng.zlib_ng import crc32

from lavendersim.errors import TraceError

MAGIC: Final = b"\x89MCAP0\r\n"
BLOCK: Final = 1024 * 1024  # bytes that are read at once
# opcode and length of the record; start of the summary, start of its offsets, CRC
_FOOTER: Final = struct.Struct("<BQQQI")
_FOOTER_OPCODE, _FOOTER_LENGTH = 0x02, 20
_DATA_END: Final = struct.Struct("<BQI")  # opcode and length; CRC
_DATA_END_OPCODE, _DATA_END_LENGTH = 0x0F, 4


INTERRUPTED: Final = "interrupted"  # how the status begins of a log that a signal ended


class LogDigest(NamedTuple):
    """What tells a closed log from every other; size and CRC stand at its end, cheap to compare."""

    size: int  # [byte]
    crc: int  # of all its bytes before DataEnd
    sha256: str  # of all its bytes, hex


class ExpectedLog(NamedTuple):
    """What the index of a run says of the log of a cell; older ones say nothing."""

    config: str = ""  # SHA-256 of the cell's resolved config, as the log has it attached
    digest: LogDigest | None = None  # of a cell that ended


class End(NamedTuple):
    """The end of a closed log."""

    data: int  # where DataEnd begins
    crc: int  # of all bytes before it
    summary: bytes  # with the footer behind it


def read_end(path: Path, stream: BinaryIO, expected: LogDigest | None = None) -> End:
    """Return the end of a log. TraceError where it was not closed, or the end fails a check.

    expected: it is no other log's.
    """
    size = stream.seek(0, 2)
    tail = _read(stream, size - _FOOTER.size - len(MAGIC), size)
    if not tail.endswith(MAGIC):
        message = f"{path}: unfinished, its end is missing: the run was killed or the file cut"
        raise TraceError(f"{message}; `lavender recover {path}` saves what is whole")
    if _read(stream, 0, len(MAGIC)) != MAGIC:
        raise TraceError(f"{path}: not an MCAP file")
    opcode, length, start, _, crc = _FOOTER.unpack_from(tail)
    summary = _read(stream, start, size - len(MAGIC))
    if (opcode, length) != (_FOOTER_OPCODE, _FOOTER_LENGTH) or crc32(summary[:-4]) != crc:
        raise TraceError(f"{path}: the summary is damaged (it fails its CRC)")
    data = start - _DATA_END.size
    record = _read(stream, data, start)
    if len(record) == _DATA_END.size:
        opcode, length, crc = _DATA_END.unpack(record)
        if (opcode, length) == (_DATA_END_OPCODE, _DATA_END_LENGTH):
            if expected is not None and (size, crc) != (expected.size, expected.crc):
                raise TraceError(_another(path, f"{size} bytes with the CRC {crc:08x}", expected))
            return End(data, crc, summary)
    raise TraceError(f"{path}: the end of its records is damaged")


def _another(path: Path, found: str, expected: LogDigest) -> str:
    wanted = f"{expected.size} bytes with the CRC {expected.crc:08x}, SHA-256 {expected.sha256}"
    return f"{path}: not the log that its run wrote there: it has {found}, the index {wanted}"


def check_closed(path: Path, expected: LogDigest | None = None) -> None:
    """Raise TraceError where a log is missing, was not closed or has been cut; reads its ends.

    expected: also where another one stands in its place.
    """
    if not path.is_file():
        raise TraceError(f"{path}: no such log")
    with path.open("rb") as stream:
        read_end(path, stream, expected)


def check_bytes(path: Path, expected: LogDigest | None = None) -> None:
    """Raise TraceError unless every byte of a log is as it was written."""
    with path.open("rb") as stream:
        end = read_end(path, stream, expected)
        found = ""
        if expected is not None:
            stream.seek(0)
            found = hashlib.file_digest(stream, "sha256").hexdigest()
            if found == expected.sha256:
                return
        if _crc_of_start(stream, end.data) != end.crc:
            raise TraceError(f"{path}: damaged, its records fail the CRC over all of them")
        if expected is not None:
            raise TraceError(_another(path, f"the SHA-256 {found}", expected))


def digest_of_closed(path: Path) -> LogDigest:
    """Return the digest of a log of which none was kept. TraceError unless its own CRCs hold."""
    check_bytes(path)
    with path.open("rb") as stream:
        crc = read_end(path, stream).crc
        stream.seek(0)
        sha256 = hashlib.file_digest(stream, "sha256").hexdigest()
        return LogDigest(stream.tell(), crc, sha256)


def _read(stream: BinaryIO, start: int, end: int) -> bytes:
    """Return bytes of a file; none where there is no such place."""
    if not 0 <= start <= end:
        return b""
    stream.seek(start)
    return stream.read(end - start)


def _crc_of_start(stream: BinaryIO, length: int) -> int:
    """Return the CRC of the first bytes of a file."""
    stream.seek(0)
    crc = 0
    while length > 0 and (block := stream.read(min(BLOCK, length))):
        crc = crc32(block, crc)
        length -= len(block)
    return crc
