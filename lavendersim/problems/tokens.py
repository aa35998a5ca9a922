"""A tokeniser of problem files: words and numbers one after the other, errors with their place.

Numbers may be separated by any white space, and by the colons of CSparse's listings. What does not
fit is reported with file, line and column.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from lavendersim.errors import ProblemError

LONGEST_QUOTE = 40
LARGEST_PLACE = 2.0**31


class Tokens:
    """A place in a text; every `take` returns what stands there and moves on."""

    def __init__(self, file: Path) -> None:
        self.file = file
        # A binary file must end in a sentence as well: undecodable bytes become odd characters.
        self._text = file.read_bytes().decode("utf-8", errors="replace").replace(":", " ")
        self._words = self._text.split()
        self._next = 0

    @property
    def left(self) -> int:
        """How many words are left."""
        return len(self._words) - self._next

    def peek(self, count: int) -> list[str]:
        """Return up to `count` coming words without moving."""
        return self._words[self._next : self._next + count]

    def word(self) -> str:
        """Take one word."""
        self._need(1, "another word")
        self._next += 1
        return self._words[self._next - 1]

    def whole(self, what: str, least: int = 0) -> int:
        """Take one whole number, at least `least`."""
        return int(self.wholes(1, what, least)[0])

    def wholes(self, count: int, what: str, least: int = 0) -> np.ndarray:
        """Take whole numbers, (count,) int64, each at least `least`."""
        self._need(count, what)
        words = self._words[self._next : self._next + count]
        try:
            values = np.array([int(word) for word in words], dtype=np.int64)
        except (ValueError, OverflowError):
            bad = next(place for place, word in enumerate(words) if not _is_whole(word))
            raise self.wrong(f"expected {what}, a whole number", bad) from None
        if count and values.min() < least:
            bad = int(np.argmax(values < least))
            raise self.wrong(f"expected {what}, at least {least}", bad)
        self._next += count
        return values

    def numbers(self, count: int, what: str) -> np.ndarray:
        """Take finite numbers, (count,) float64."""
        self._need(count, what)
        words = self._words[self._next : self._next + count]
        try:
            values = np.array(words, dtype=np.float64)
        except ValueError:
            bad = next(place for place, word in enumerate(words) if not _is_number(word))
            raise self.wrong(f"expected {what}, {_count(count)}", bad) from None
        if not np.isfinite(values).all():
            bad = int(np.argmin(np.isfinite(values)))
            raise self.wrong(f"expected {what}, finite", bad)
        self._next += count
        return values

    def entries(self, count: int, places: int, what: str) -> tuple[np.ndarray, np.ndarray]:
        """Take lines of whole numbers from 0 and a value; returns (count, places), (count,).

        Whole by their value: a listing may print them in any way.
        """
        start = self._next
        table = self.numbers((places + 1) * count, what).reshape(count, places + 1)
        found = table[:, :-1]
        bad = (found < 0.0) | (found > LARGEST_PLACE) | (found != np.floor(found))
        if bad.any():
            line, place = np.argwhere(bad)[0]
            self._next = start
            ahead = int(line) * (places + 1) + int(place)
            raise self.wrong(f"expected {what}, each place a whole number from 0", ahead)
        return found.astype(np.int64), table[:, -1]

    def wrong(self, sentence: str, ahead: int = 0) -> ProblemError:
        """Return the error that the word `ahead` of this place is not what was expected."""
        place = self._next + ahead
        if place >= len(self._words):
            line = self._text.rstrip().count("\n") + 1
            return ProblemError(f"{self.file}:{line}: {sentence}, but the file ends here")
        found = " ".join(self._words[place].split())[:LONGEST_QUOTE]
        return ProblemError(f'{self._where(place)}: {sentence}, found "{found}"')

    def _where(self, place: int) -> str:
        """Return file:line:column of a word."""
        for index, match in enumerate(re.finditer(r"\S+", self._text)):
            if index == place:
                lines = self._text[: match.start()].split("\n")
                return f"{self.file}:{len(lines)}:{len(lines[-1]) + 1}"
        return str(self.file)

    def _need(self, count: int, what: str) -> None:
        if count > self.left:
            line = self._text.rstrip().count("\n") + 1
            raise ProblemError(
                f"{self.file}:{line}: expected {what}, {_count(count)}, but the file ends after "
                f"{self.left}"
            )


def _count(count: int) -> str:
    return "a number" if count == 1 else f"{count} numbers"


def _is_whole(word: str) -> bool:
    try:
        return abs(int(word)) < 2**63
    except ValueError:
        return False


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
