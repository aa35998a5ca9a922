"""The verdict on one claim: passed or not, with everything that a person needs to see why."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

NO_TOLERANCE: Final = "none"


class Outcome(NamedTuple):
    """The verdict on numbers alone, before it knows its name and its log."""

    passed: bool
    measured: float  # the decisive number: of a row, or of several cells, the worst
    expected: str
    tolerance: str
    reason: str = ""  # where it failed, when the numbers do not say it
    follows: bool = False  # failed because the cell did not complete
    margin: float = float("nan")  # share of the bound that is left; below 0 outside [-]
    judged: bool = True  # False: the engine does not report what it takes, `reason` says so


class Verdict(NamedTuple):
    """One judged expectation, in one cell or across cells."""

    name: str
    node: str  # `rebound at e=0.8, timestep=1/480`
    passed: bool
    measured: float  # the decisive number: of a row, or of several cells, the worst
    expected: str
    tolerance: str
    own_message: str  # all of its message, where that is not of the numbers alone
    path: str  # of the log, or of the logs' directory when several are compared
    follows: bool = False  # failed because the cell did not complete
    margin: float = float("nan")  # share of the bound that is left; NaN where there is no such
    measure: str = ""  # what was judged
    reason: str = ""  # where it failed, when the numbers do not say it
    judged: bool = True  # False: the engine does not report what it takes; then it is not passed

    @property
    def fails(self) -> bool:
        """Whether it was judged and not met."""
        return self.judged and not self.passed

    @property
    def message(self) -> str:
        """Everything that a person needs; of many verdicts it is longer than what it is made of."""
        if self.own_message:
            return self.own_message
        lines = [
            f"{self.node}: {self.word}",
            f"  measured   {self.measured!r}{f' ({self.measure})' if self.measure else ''}",
            f"  expected   {self.expected}",
            f"  tolerance  {self.tolerance}",
        ]
        lines += [f"  because    {self.reason}"] if self.reason else []
        lines += [f"  log        {self.path}"] if self.path else []
        return "\n".join(lines)

    @property
    def word(self) -> str:
        """What became of it, in a word or two."""
        return ("passed" if self.passed else "FAILED") if self.judged else "not judged"

    @property
    def row(self) -> dict[str, Any]:
        """What tables say of it."""
        found = {
            "name": self.name,
            "node": self.node,
            "passed": self.passed,
            "measured": self.measured,
            "expected": self.expected,
            "tolerance": self.tolerance,
            "message": self.message,
            "path": self.path,
            "follows": self.follows,
            "margin": self.margin,
        }
        return found if self.judged else {**found, "judged": False}


def unjudged(reason: str) -> Outcome:
    """Return the outcome of what an engine does not report enough to judge."""
    return Outcome(False, float("nan"), "a log that can answer", NO_TOLERANCE, reason, judged=False)


def failure(expected: str, reason: str, follows: bool = False) -> Outcome:
    """Return the outcome of an expectation for which there is nothing to measure."""
    return Outcome(False, float("nan"), expected, NO_TOLERANCE, reason, follows)
