"""Slow experiments under pytest and on the command line: reduced, unless all of it is asked for."""

from __future__ import annotations

import pytest

from tests.drop_config import DROP

SLOW = """measure:
  lasts: {kind: simulated_duration}
  rebound: {kind: first_apex, body: ball, above: floor}
expect:
  - {name: as long as it says, measure: lasts, exactly: %s}
slow: true
reduced: {duration: 0.25}
"""
TEXT = DROP[: DROP.index("measure:\n")] + SLOW


def run(pytester: pytest.Pytester, *arguments: str) -> pytest.RunResult:
    return pytester.runpytest_subprocess("-p", "no:cacheprovider", *arguments)


def test_pytest_runs_the_reduced_length_and_all_of_it_when_asked(
    pytester: pytest.Pytester,
) -> None:
    pytester.makefile(".yaml", short=TEXT % 0.25, full=TEXT % 0.5)
    run(pytester, "short.yaml").assert_outcomes(passed=2)
    run(pytester, "--lavender-full", "full.yaml").assert_outcomes(passed=2)


def test_slow_experiments_are_marked(pytester: pytest.Pytester) -> None:
    pytester.makefile(".yaml", slow=TEXT % 0.25, drop=DROP)
    chosen = run(pytester, "--collect-only", "-q", "--strict-markers", "-m", "not slow")
    chosen.stdout.fnmatch_lines(["drop.yaml::every cell completes", "2/4 tests collected*"])
