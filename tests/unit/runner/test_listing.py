"""Runs as they are listed: spans, sizes and tags in words, and which runs are meant."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

from lavendersim.errors import UsageError
from lavendersim.runner.listing import (
    VERDICTS,
    Listed,
    RunFilter,
    _date,
    checked_tags,
    size_from,
    time_before,
    verdict_of,
)

NOW = datetime(2026, 4, 12, 12, 0, tzinfo=UTC)
RUN: Any = None


def listed(**changes: Any) -> Listed:
    one = Listed(RUN, "tower", "", NOW, 3, 2_000_000, ("good",), True, 2, [])
    return one._replace(**changes)


@pytest.mark.parametrize(
    ("text", "hours"), [("90min", 1.5), ("12h", 12), ("30 d", 720), ("2w", 336), ("1.5h", 1.5)]
)
def test_a_span_is_that_long_ago(text: str, hours: float) -> None:
    assert time_before("--before", text, NOW) == NOW - timedelta(hours=hours)


def test_a_date_begins_at_midnight_of_universal_time() -> None:
    assert time_before("--before", "2026-04-12") == datetime(2026, 4, 12, tzinfo=UTC)


@pytest.mark.parametrize("text", ["soon", "12", "-3h", "2026-13-01", "9999999999w", "12 years"])
def test_other_times_are_refused_with_their_option(text: str) -> None:
    with pytest.raises(UsageError, match=f"--since {text}: expected a span such as 12h"):
        time_before("--since", text)


@pytest.mark.parametrize(
    ("text", "size"), [("200MB", 2e8), ("1.5 GB", 1.5e9), ("7B", 7.0), ("3kB", 3e3), ("1TB", 1e12)]
)
def test_a_size_is_in_decimal_units(text: str, size: float) -> None:
    assert size_from("--larger", text) == size


@pytest.mark.parametrize("text", ["200", "MB", "2KB", "1 gb", "-1MB"])
def test_other_sizes_are_refused(text: str) -> None:
    with pytest.raises(UsageError, match="expected a size such as 200MB"):
        size_from("--larger", text)


def test_tags_are_words_each_once() -> None:
    assert checked_tags(["b", "a", "b", "v1.2+x-y"]) == ("b", "a", "v1.2+x-y")
    for tag in ("two words", "", "a/b", "x" * 61):
        with pytest.raises(UsageError, match="expected a word"):
            checked_tags([tag])


@pytest.mark.parametrize(
    ("changes", "verdict"),
    [
        ({}, "pass"),
        ({"passed": False}, "fail"),
        ({"claims": 0}, "unclaimed"),
        ({"claims": 0, "passed": False}, "fail"),
        ({"passed": None}, "unfinished"),
        ({"damaged": ["cut"]}, "damaged"),
        ({"damaged": ["cut"], "passed": None}, "damaged"),
    ],
)
def test_a_run_ended_in_one_of_five_ways(changes: dict[str, Any], verdict: str) -> None:
    assert verdict_of(listed(**changes)) == verdict
    assert verdict in VERDICTS
    assert RunFilter(verdict=verdict).has(listed(**changes))


@pytest.mark.parametrize(
    ("chosen", "good"),
    [
        (RunFilter(), True),
        (RunFilter(names=("jenga", "tow*")), True),
        (RunFilter(names=("tow",)), False),
        (RunFilter(tag="good"), True),
        (RunFilter(tag="goo"), False),
        (RunFilter(before=NOW), True),
        (RunFilter(before=NOW - timedelta(seconds=1)), False),
        (RunFilter(since=NOW), True),
        (RunFilter(since=NOW + timedelta(seconds=1)), False),
        (RunFilter(larger=2e6), True),
        (RunFilter(larger=2e6 + 1), False),
        (RunFilter(names=("tower",), verdict="fail"), False),
    ],
)
def test_every_condition_has_to_hold(chosen: RunFilter, good: bool) -> None:
    assert chosen.has(listed()) is good


def test_a_run_began_when_its_name_says_or_else_its_folder(tmp_path: Path) -> None:
    named = tmp_path / "20260412T120000Z.001-tower-abc"
    assert _date(named) == NOW
    renamed = tmp_path / "the good one"
    renamed.mkdir()
    assert abs(_date(renamed) - datetime.now(UTC)) < timedelta(minutes=5)
    impossible = tmp_path / "20269912T120000Z-tower"
    impossible.mkdir()
    assert abs(_date(impossible) - datetime.now(UTC)) < timedelta(minutes=5)
