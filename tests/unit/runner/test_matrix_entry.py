"""What an entry of the solver matrix says of a run."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.clock import Clock
from lavendersim.measures import Verdict
from lavendersim.runner.matrix_entry import Entry, entry_of, passed, with_counts
from lavendersim.runner.step_counts import StepCounts

BEYOND = "beyond bounds: residual 0.1 m/s, at most 1e-06, ball, in step 3 (t = 0.0125 s)"

DIVERGED = "diverged: body ball is no longer finite after step 3 (t = 0.0125 s)"


def verdict(node: str, good: bool, follows: bool = False, margin: float = math.nan) -> Verdict:
    name, text = node.split()[0], f"{node}: measured 2.0"
    path = "run/cells/b.mcap" if node.endswith("b") else "run/cells/a.mcap"
    return Verdict(name, node, good, 2.0, "at most 1", "none", text, path, follows, margin)


@dataclass
class Ran:
    """A finished run of two cells, a and b, of 10 and 30 steps of 1/100 s."""

    raw: list[Verdict]
    controlled: tuple[str, ...] = ()  # nodes that a declared failure has taken over
    ended: str = ""  # status of cell b
    declared: tuple[str, ...] = ()  # names of claims that are; of those in `controlled`, if none
    starts: tuple[dict[str, int], ...] = ({}, {})  # coordinates of a and b
    outcomes: list[Any] = field(
        default_factory=lambda: [
            SimpleNamespace(physics_ns=1_000_000, steps=10),
            SimpleNamespace(physics_ns=3_000_000, steps=30),
        ]
    )

    @property
    def verdicts(self) -> list[Verdict]:
        return [one for one in self.raw if one.node not in self.controlled]

    @property
    def run(self) -> Any:
        whole = SimpleNamespace(config=SimpleNamespace(clock=Clock(Fraction(1, 100))))
        cells = [
            SimpleNamespace(
                path=Path("run/cells/a.mcap"),
                label="cell a",
                status="complete",
                coordinates=self.starts[0],
            ),
            SimpleNamespace(
                path=Path("run/cells/b.mcap"),
                label="cell b",
                status=self.ended,
                coordinates=self.starts[1],
            ),
        ]
        controls = self.declared or {node.split()[0] for node in self.controlled}
        experiment = SimpleNamespace(
            cells=lambda: [whole, whole],
            controls=[SimpleNamespace(fails=name) for name in controls],
        )
        return SimpleNamespace(path=Path("run"), cells=cells, experiment=experiment)

    @property
    def ended_early(self) -> list[Any]:
        return [cell for cell in self.run.cells if cell.status == self.ended and self.ended]


def entry(*raw: Verdict, controlled: tuple[str, ...] = (), ended: str = "") -> Entry:
    return entry_of("family/case", "jacobi", Ran(list(raw), controlled, ended))


def test_a_case_of_which_every_claim_is_met_passes() -> None:
    one = entry(verdict("stands a", True, margin=0.5), verdict("stands b", True, margin=0.25))
    assert (one.verdict, one.why, one.margin, one.fine) == ("passes", "", 0.25, True)
    assert one.log == Path("run/cells/a.mcap")


def test_a_failure_says_what_failed_first_with_its_number_and_its_bound() -> None:
    one = entry(verdict("stands a", True), verdict("force b", False), verdict("sinks a", False))
    assert (one.verdict, one.why, one.fine) == ("fails", "force b: 2, expected at most 1", False)
    assert one.detail == "force b: measured 2.0"
    # the first log of one that failed, in the order of the cells
    assert one.log == Path("run/cells/a.mcap")


def test_the_number_behind_a_verdict_is_that_of_what_failed_or_of_what_is_nearest_its_bound() -> (
    None
):
    near = verdict("slips by a", True, margin=0.1)._replace(measured=0.9)
    far = verdict("turns by a", True, margin=0.8)._replace(measured=0.2)
    bad = verdict("sinks by b", False, margin=-1.0)._replace(measured=3.0)
    assert entry(far, near, verdict("is named a", True)).number == 0.9
    assert entry(far, near).claim == "slips by a: 0.9, expected at most 1"
    assert entry(far, near, bad).number == 3.0
    alone = entry(verdict("is named a", True))  # it has no bound to be near to
    assert math.isnan(alone.number)
    assert alone.claim == ""


def test_a_declared_failure_is_no_pass_and_no_news() -> None:
    one = entry(verdict("stands a", True), verdict("force b", False), controlled=("force b",))
    assert (one.verdict, one.fine) == ("known failure", True)
    assert one.why == "force b: 2, expected at most 1"
    assert passed([one], "jacobi") == 0


def test_a_solver_that_holds_what_is_declared_to_fail_passes() -> None:
    one = entry(verdict("stands a", True), verdict("force b", True), controlled=("force b",))
    assert one.verdict == "passes"
    assert passed([one], "jacobi") == 1


def test_a_declared_failure_hides_no_other() -> None:
    one = entry(verdict("force b", False), verdict("stands a", False), controlled=("force b",))
    assert (one.verdict, one.fine) == ("fails", False)
    assert one.why == "stands a: 2, expected at most 1"


def test_what_a_declared_bound_keeps_from_being_judged_is_not_declared() -> None:
    # a control of a check of `always` takes the expectations of its cells too, as it may stop them
    ran = Ran([verdict("depth b", True), verdict("stands b", False)], ("depth b", "stands b"))
    ran.declared = ("depth",)
    one = entry_of("family/case", "jacobi", ran)
    assert (one.verdict, one.why) == ("fails", "stands b: 2, expected at most 1")


@pytest.mark.parametrize(("status", "word"), [(DIVERGED, "diverged"), (BEYOND, "beyond bounds")])
def test_a_cell_that_ended_early_says_how(status: str, word: str) -> None:
    one = entry(verdict("stands a", True), verdict("force b", False, True), ended=status)
    said = status.removeprefix(f"{word}: ")  # once, not twice
    assert (one.verdict, one.why, one.fine) == (word, f"cell b: {said}", False)
    assert one.log == Path("run/cells/b.mcap")


def test_the_cost_is_the_physics_of_all_cells_over_their_simulated_time() -> None:
    # 4 ms for (10 + 30) / 100 s
    assert entry(verdict("stands a", True)).cost == pytest.approx(0.004 / 0.4, rel=1e-12)


def test_over_perturbed_starts_the_number_has_its_spread() -> None:
    """Of each start the verdict that leaves least of its bound; other claims say nothing of it."""
    high = verdict("claim at b", False, margin=-1.0)._replace(measured=4.0)
    low = verdict("claim at a", True, margin=0.5)._replace(measured=0.5)
    lower = verdict("claim early at a", True, margin=0.75)._replace(measured=0.25)
    raw = [lower, low, high, verdict("other at a", True, margin=0.9)]
    seeds = ({"start_seed": 0}, {"start_seed": 1})
    found = entry_of("case", "engine", Ran(raw, starts=seeds))
    assert (found.number, found.least, found.most) == (4.0, 0.5, 4.0)
    assert math.isnan(entry_of("case", "engine", Ran(raw)).least)


def test_what_an_engine_does_not_report_of_its_steps_is_no_number() -> None:
    one = with_counts(entry(verdict("stands a", True)), StepCounts(12.0, None))
    assert one.contacts == 12.0
    assert math.isnan(one.iterations)
