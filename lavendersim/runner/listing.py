"""What there is to say of a run in one line, and which runs of a folder are meant."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from datetime import UTC, datetime, timedelta
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Final, NamedTuple

from lavendersim.errors import TraceError, UsageError

from .cells_index import IndexRow
from .run_directory import Run, list_runs

TAGS: Final = "tags.txt"
_STAMP: Final = re.compile(r"(\d{8}T\d{6}Z)")
_SPANS: Final = {"s": 1, "min": 60, "h": 3600, "d": 86_400, "w": 604_800}
_SIZES: Final = {"B": 1.0, "kB": 1e3, "MB": 1e6, "GB": 1e9, "TB": 1e12}


class Listed(NamedTuple):
    """A run as it is listed; of one with a damaged index little more than its date is known."""

    run: Run
    name: str
    question: str  # empty where its config has none, or an older version ran it
    date: datetime  # when it began
    cells: int
    size: int  # of its logs [B]
    tags: tuple[str, ...]
    passed: bool | None  # None: not finished, or its results are damaged
    claims: int  # that were judged; of a run without one `passed` says that its cells completed
    damaged: list[str]  # a sentence of each log that was cut, and of each table that is damaged

    def as_row(self) -> dict[str, Any]:
        """Return it as plain data."""
        row = self._asdict()
        del row["run"]
        finished = {"path": self.run.path, "finished": self.run.finished}
        return finished | row | {"date": self.date.isoformat(), "tags": list(self.tags)}


class RunFilter(NamedTuple):
    """Which runs are meant; what is None asks for nothing."""

    names: tuple[str, ...] = ()  # of experiments; * and ? as in a shell
    verdict: str | None = None  # one of VERDICTS
    tag: str | None = None
    before: datetime | None = None  # it began then, or earlier
    since: datetime | None = None  # it began then, or later
    larger: float | None = None  # its logs take at least so much [B]

    def has(self, one: Listed) -> bool:
        """Whether a run is meant."""
        return (
            (not self.names or any(fnmatchcase(one.name, name) for name in self.names))
            and (self.verdict is None or self.verdict == verdict_of(one))
            and (self.tag is None or self.tag in one.tags)
            and (self.before is None or one.date <= self.before)
            and (self.since is None or one.date >= self.since)
            and (self.larger is None or one.size >= self.larger)
        )


VERDICTS: Final = ("pass", "fail", "unclaimed", "unfinished", "damaged")


def verdict_of(one: Listed) -> str:
    """Return how a run ended, in one of VERDICTS."""
    if one.damaged:
        return "damaged"
    if one.passed is None:
        return "unfinished"
    if not one.passed:
        return "fail"
    return "pass" if one.claims else "unclaimed"


def listed(root: Path, chosen: RunFilter = RunFilter()) -> Iterator[Listed]:  # noqa: B008 - immutable
    """Return the runs below a folder that are meant, oldest first."""
    return (one for one in map(listed_run, list_runs(root)) if chosen.has(one))


def listed_run(run: Run) -> Listed:
    """Return what there is to say of a run; a damaged one is not in the way of others."""
    passed: bool | None = None
    claims = 0
    damaged: list[str] = []
    name, question, cells = "", "", 0
    rows: dict[Path, IndexRow] = {}
    try:
        name, question, cells = run.name, run.question, len(run.index_rows())
        rows = run.rows()
        if run.finished:  # another is listed as such; its logs are as they were left
            results = run.results()
            passed, claims = results.passed, len(results.checks)
            damaged = run.cut()
    except TraceError as error:
        damaged = [str(error)]
    sizes = (_size(log, row) for log, row in rows.items())
    size, date, tags = sum(sizes), _date(run.path), tags_of(run)
    return Listed(run, name, question, date, cells, size, tags, passed, claims, damaged)


def tags_of(run: Run) -> tuple[str, ...]:
    """Return the tags of a run, in the order in which they were given."""
    try:
        return tuple((run.path / TAGS).read_text(encoding="utf-8", errors="replace").split())
    except OSError:
        return ()


def checked_tags(tags: Iterable[str]) -> tuple[str, ...]:
    """Return tags, each once. UsageError where one is no word."""
    for tag in tags:
        if not re.fullmatch(r"[\w.+-]{1,60}", tag):
            raise UsageError(f"--tag {tag!r}: expected a word of letters, digits, _, ., + and -")
    return tuple(dict.fromkeys(tags))


def time_before(option: str, text: str, now: datetime | None = None) -> datetime:
    """Return the time that is `90min`, `12h`, `30d` or `2w` ago, or that of a date `2026-04-12`.

    UsageError, with the option that has it, where it is no such time.
    """
    found = re.fullmatch(rf"(\d+(?:\.\d+)?) ?({'|'.join(_SPANS)})", text)
    try:
        if found:
            span = timedelta(seconds=float(found[1]) * _SPANS[found[2]])
            return (now or datetime.now(UTC)) - span
        return datetime.strptime(text, "%Y-%m-%d").replace(tzinfo=UTC)
    except (ValueError, OverflowError):
        sentence = f"{option} {text}: expected a span such as 12h, 30d or 2w, or a date 2026-04-12"
        raise UsageError(sentence) from None


def size_from(option: str, text: str) -> float:
    """Return the size [B] that `200MB` or `1.5GB` says. UsageError where it is none."""
    found = re.fullmatch(rf"(\d+(?:\.\d+)?) ?({'|'.join(_SIZES)})", text)
    if not found:
        raise UsageError(f"{option} {text}: expected a size such as 200MB or 1.5GB")
    return float(found[1]) * _SIZES[found[2]]


def _date(path: Path) -> datetime:
    """Return when a run began: its name says so; of one that was renamed its directory's time."""
    if stamp := _STAMP.match(path.name):
        try:
            return datetime.strptime(stamp[1], "%Y%m%dT%H%M%SZ").replace(tzinfo=UTC)
        except ValueError:
            pass
    return datetime.fromtimestamp(path.stat().st_mtime, UTC).replace(microsecond=0)


def _size(log: Path, row: IndexRow) -> int:
    if row.log is not None:
        return row.log.size
    try:
        return log.stat().st_size
    except OSError:
        return 0
