"""What verbs print of many cells: counts, ranges, the worst cell, the first failures.

A screen has some 50 lines; `-v` prints each cell and claim.
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from command_line import lavender

from lavender_cli.cell_lines import line_of, summary_of
from lavender_cli.claims import print_claims, print_failures, summarise
from lavender_cli.printing import print_unjudged
from lavendersim.measures.specs.states import FirstPassage
from lavendersim.measures.verdict import Verdict
from lavendersim.runner.run_results import CellResult
from tests.drop_config import DROP

SCREEN = 50  # lines
CELLS = 2000


def claim(name: str, cell: int, measured: float, bound: float = 1.0) -> Verdict:
    """One claim of a cell: at most `bound`."""
    node = f"{name} at e={cell}"
    passed = measured <= bound
    message = f"{node}: {'passed' if passed else 'FAILED'}\n  measured   {measured}"
    expected = f"at most {bound:g} m"
    margin = 1.0 - measured / bound
    return Verdict(name, node, passed, measured, expected, "", message, "", margin=margin)


def row(index: int, **changed: Any) -> CellResult:
    """A cell in the results."""
    made = CellResult(
        index,
        label=f"e={index}",
        status="complete",
        steps=100,
        measures={"height": float(index)},
        physics_us_per_step=0.5,
        logging_us_per_step=0.1,
        compile_s=0.0,
        tolerance=1e-6,
        worst_residual=1e-9,
        not_converged_steps=0,
    )
    return replace(made, **changed)


def test_a_line_has_the_count_the_range_and_the_cell_that_is_next_to_its_bound() -> None:
    judged = [claim("low", cell, (cell % 7) / 10) for cell in range(CELLS)]
    judged[1234] = claim("low", 1234, 0.93)
    (line,) = summarise(judged)
    assert line.passed
    assert line.text == (
        "low: 0 to 0.93, expected at most 1 m in 2000 of 2000 cells; "
        "nearest its bound at e=1234, 0.93"
    )


def test_the_worst_of_what_failed_is_named_and_numbers_that_are_none_are_in_no_range() -> None:
    judged = [claim("low", 0, 0.5), claim("low", 1, 1.5), claim("low", 2, 3.0)]
    judged.append(claim("low", 3, math.nan)._replace(passed=False))
    (line,) = summarise(judged)
    assert not line.passed
    assert line.text == "low: 0.5 to 3, expected at most 1 m in 1 of 4 cells; worst at e=2, 3"


def test_what_is_expected_is_that_of_the_cells_that_have_ended() -> None:
    judged = [claim("low", 0, 0.5), claim("low", 1, 0.8)]
    judged.append(claim("low", 2, math.nan)._replace(passed=False, expected="a complete run"))
    (line,) = summarise(judged)
    assert line.text == (
        "low: 0.5 to 0.8, expected at most 1 m in 2 of 3 cells; nearest its bound at e=1, 0.8"
    )
    (line,) = summarise([judged[2], judged[2]])
    assert line.text == "low: nan, expected a complete run in 0 of 2 cells"


def test_a_claim_is_printed_with_its_formula_its_tolerance_and_digits_of_use() -> None:
    one = claim("speed", 0, 4.429)._replace(
        expected="4.4294469180700204 (sqrt(2*$g*$h))", tolerance="0.01 relative"
    )
    other = one._replace(expected="3.1304951684997055 (sqrt(2*$g*$h))", node="speed at e=1")
    (line,) = summarise([one])
    assert line.text == "speed: 4.429, expected 4.42945 (sqrt(2*$g*$h)), within 0.01 relative"
    (line,) = summarise([one, other])
    assert "expected the cell's sqrt(2*$g*$h) in 0 of 2 cells" in line.text
    (line,) = summarise([claim("low", 0, 2.5)._replace(expected="at least 1.0", passed=True)])
    assert line.text == "low: 2.5, expected at least 1"


def test_a_residual_that_an_engine_does_not_report_is_none() -> None:
    silent = row(1, worst_residual=math.nan, not_converged_steps=None)
    assert "residual not recorded" in line_of(silent)
    assert "residual <= 1e-09 m/s, largest at e=0" in summary_of([row(0), silent])
    assert "residual not recorded" in summary_of([silent, silent])


def test_checks_of_every_step_that_are_met_are_one_line_and_others_stand_alone() -> None:
    names = ("always: energy", "always: penetration", "always: speed")
    judged = [claim(name, cell, 0.1) for cell in range(3) for name in names]
    judged[4] = claim(names[1], 1, 0.75)
    (line,) = summarise(judged)
    assert line.text == (
        "always: 3 checks of every step met in 3 cells; "
        "nearest its bound: penetration 0.75 of at most 1 m at e=1"
    )
    judged[4] = claim(names[1], 1, 2.0)
    failed, others = summarise(judged)
    assert (failed.passed, others.passed) == (False, True)
    assert failed.text.startswith("always: penetration: 0.1 to 2, ")
    assert others.text.startswith("always: 2 other checks of every step met in 3 cells")


def test_verdicts_of_older_runs_have_no_margin_and_no_nearest() -> None:
    (line,) = summarise([claim("low", cell, 0.5)._replace(margin=math.nan) for cell in range(2)])
    assert line.text == "low: 0.5, expected at most 1 m in 2 of 2 cells"


def test_two_thousand_cells_with_failures_fit_on_a_screen(capsys: pytest.CaptureFixture) -> None:
    judged = [claim(name, cell, 2.0) for name in "abcd" for cell in range(CELLS)]
    ended = [row(cell, status=f"diverged: at step {cell}") for cell in range(CELLS // 2)]
    whole = [row(cell) for cell in range(CELLS // 2, CELLS)]
    lines = summary_of(ended + whole)
    assert lines[0] == "1000 of 2000 complete"
    assert "and 995 more ended early" in lines
    print_claims(judged)
    print_failures([], judged)
    said = capsys.readouterr().out.splitlines()
    assert said[-1] == f"  and {4 * CELLS - 3} more failed, -v prints each"
    assert len(lines) + len(said) <= SCREEN / 2  # the plan and the title have the rest
    print_claims(judged, verbose=True)
    print_failures([], judged, verbose=True)
    assert len(capsys.readouterr().out.splitlines()) == 3 * 4 * CELLS  # a claim, a failure of two


def test_many_cells_are_ranges_with_their_places() -> None:
    rows = [row(cell) for cell in range(20)]
    rows[7] = row(7, worst_residual=2e-4, not_converged_steps=3)
    rows[11] = row(11, not_converged_steps=40)
    rows[5] = row(5, measures={"height": math.nan})
    rows[6] = row(6, measures={"height": "no contact in 0.5 s"})
    assert summary_of(rows) == [
        "20 of 20 complete",
        "physics  0.5 us/step",
        "residual <= 0.0002 m/s, largest at e=7",
        "43 steps of 2 cells above the tolerance, most at e=11: 40 of 100",
        "height  0 at e=0 to 19 at e=19",
        "height  not a number in 2 of 20 cells",
    ]


def test_a_residual_that_is_no_number_is_the_largest() -> None:
    rows = [row(0), row(1, worst_residual=math.nan), row(2, worst_residual=3.0)]
    assert "residual <= nan m/s, largest at e=1" in summary_of(rows)


def test_a_run_is_checked_and_shown_in_short_and_with_v_cell_by_cell(tmp_path: Path) -> None:
    values = [round(0.40 + 0.01 * k, 2) for k in range(16)]
    swept = f"sweep:\n  e: {{path: scene.bodies.ball.surface.restitution, values: {values}}}\n"
    text = DROP.replace("measure:\n", swept + "measure:\n")
    (tmp_path / "drop.yaml").write_text(text)
    # e^2 0.1 m is between 0.02 and 0.03 m from e = 0.45 to 0.54: ten of them.
    for words in (("check", "drop.yaml"), ("show",), ("judge",)):
        short = lavender(*words, where=tmp_path).stdout.splitlines()
        full = lavender(*words, "-v", where=tmp_path).stdout.splitlines()
        assert sum(" in 10 of 16 cells" in line for line in short) == 1, short
        assert not any(" in 10 of 16 cells" in line for line in full)
        assert all(sum(f"rebound at e={value:g}: " in x for x in full) for value in values)
        assert len(short) < len(full)


def test_of_a_measure_without_a_number_the_reason_is_printed_and_no_nan(
    capsys: pytest.CaptureFixture[str],
) -> None:
    spec = FirstPassage(kind="first_passage", along=(0, 0, 1), level=1.0)
    experiment = SimpleNamespace(unjudged=["time"], measures={"time": spec})
    taken = {0: {"time": 0.5}, 1: {"time": math.nan}, 2: {"time": 0.75}}
    print_unjudged(SimpleNamespace(run=SimpleNamespace(experiment=experiment, taken=taken)))
    assert capsys.readouterr().out.splitlines() == [
        "        time: 0.5 to 0.75 s",
        "        time: no number in 1 of 3 cells: the centre never crosses that level so",
    ]
