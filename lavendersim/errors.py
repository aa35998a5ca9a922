"""Errors that a user can cause: one base class, and its kinds; each knows its exit code."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple


class Defect(NamedTuple):
    """One thing wrong with a config file: where it stands and a sentence that says what to do."""

    file: str
    line: int
    column: int
    message: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}: {self.message}"


class LavenderError(Exception):
    """Base of all errors shown to a person as one sentence, without a traceback."""

    exit_code = 4


class UsageError(LavenderError):
    """The command line asks for something that does not exist or cannot be."""

    exit_code = 2


class NotReportedError(UsageError):
    """A log has not what is asked of it, because the engine that made it does not report it."""


# How a reason ends where an engine does not report what is asked of its log: a measure's reason is
# kept as a text, and raised again from it.
NOT_REPORTED: Final = "does not report it"
_IN_OLDER_LOGS: Final = "does not tell it"


def is_not_reported(sentence: str) -> bool:
    """Whether a reason is that the engine does not report what is asked of its log."""
    return sentence.endswith((NOT_REPORTED, _IN_OLDER_LOGS))


def unanswerable(sentence: str) -> UsageError:
    """Return the error of a log that has not what is asked of it, by the reason it gives."""
    return NotReportedError(sentence) if is_not_reported(sentence) else UsageError(sentence)


class ConfigError(LavenderError):
    """A config file is wrong; carries every defect found in it, in the order of the file."""

    exit_code = 2

    def __init__(self, defects: Sequence[Defect]) -> None:
        self.defects = tuple(defects)
        super().__init__("\n".join(str(defect) for defect in self.defects))


class ConfigWarning(FutureWarning):
    """A config file uses a spelling that the next version refuses; the message has its place."""


class SuspiciousScene(UserWarning):
    """A config can be simulated and is probably not what is meant; the message has its place."""


class ProblemError(LavenderError):
    """A file that has a contact problem is not what its format says, or cannot be read."""

    exit_code = 2


class MissingDriverError(LavenderError):
    """Something outside Python (a graphics driver, a viewer) is not installed."""

    exit_code = 2


class TraceError(LavenderError):
    """A log or a table of a run is damaged, unfinished or of another version."""

    exit_code = 3


class OtherVersionError(TraceError):
    """A whole log, or a run, of a version whose configs this one cannot read."""
