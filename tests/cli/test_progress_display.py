"""What is shown while a run goes on: two lines of a terminal, or a line every ten seconds."""

from __future__ import annotations

import io
from typing import Any

import pytest
from rich.console import Console

from lavender_cli.printing import byte_size, time_span
from lavender_cli.progress import EVERY, ShownState
from lavendersim.engine.spec import Spec
from lavendersim.runner.progress import Compilation, Moment

HALF_WAY = Moment(
    cells_done=3,
    cells=12,
    seconds_done=16.34,
    seconds=60.0,
    label="friction=0.3",
    cell_seconds_done=1.34,
    cell_seconds=5.0,
    share=0.272,
    worked=25.0,
    remaining=72.4,
    written=1_234_000_000,
)


class Reading:
    """A tally that reads what a test sets."""

    def __init__(self, moment: Moment) -> None:
        self.moment = moment

    def read(self) -> Moment:
        return self.moment


def compilation(number: int, total: int) -> Compilation:
    class Plan:
        spec = Spec(effects=("friction", "gravity", "rotation"), shape_pairs=("box_box",) * 20)

    plan: Any = Plan()
    return Compilation(plan, f"solver: number_{number} (3 cells)", number, total)


def running(moment: Moment) -> ShownState:
    state, tally = ShownState("pile"), Reading(moment)
    state.running(tally)  # type: ignore[arg-type]
    return state


def drawn(state: ShownState, width: int = 80) -> list[str]:
    console = Console(file=io.StringIO(), width=width, force_terminal=True, color_system=None)
    with console.capture() as captured:
        console.print(state.drawn(console))
    return [line.rstrip() for line in captured.get().splitlines()]


def test_two_lines_of_80_columns_have_it_all() -> None:
    first, second = drawn(running(HALF_WAY))
    assert first.startswith("pile  3 of 12 cells  ━")
    assert first.endswith(" 27 %  1 min 12 s left")
    assert second == "      16.3 of 60 s simulated, 1.23 GB written; 1.34 of 5 s in friction=0.3"
    assert max(len(first), len(second)) <= 80


@pytest.mark.parametrize("width", [30, 50, 80, 200])
def test_it_never_wraps(width: int) -> None:
    long = HALF_WAY._replace(label=", ".join(f"axis_{k}=0.{k}" for k in range(9)))
    several = ShownState("pile")
    for number in range(1, 6):
        several.compiling(compilation(number, 5))
    for state in (running(HALF_WAY), running(long), several):
        lines = drawn(state, width)
        assert len(lines) == 2
        assert max(map(len, lines)) <= width


def test_kernels_are_counted_while_they_are_compiled() -> None:
    state = ShownState("pile")
    state.compiling(compilation(2, 3))
    first, second = drawn(state)
    assert first.startswith("pile  compiling 2 of 3 (")
    assert second.startswith(
        "      solver: number_2 (3 cells): friction, gravity, rotation; box_box"
    )
    state.compiling(compilation(3, 3))
    assert drawn(state)[0].startswith("pile  compiling 3, 1 done (")
    for number in (2, 3):
        state.compiled(compilation(number, 3))
    state.running(Reading(HALF_WAY))  # type: ignore[arg-type]
    assert drawn(state)[0].startswith("pile  3 of 12 cells")


def test_a_line_comes_only_after_another_ten_seconds_of_work() -> None:
    state = running(HALF_WAY._replace(worked=EVERY - 0.1))
    assert state.line() == ""
    tally = Reading(HALF_WAY._replace(worked=EVERY))
    state.running(tally)  # type: ignore[arg-type]
    assert state.line() == (
        "3 of 12 cells; 16.3 of 60 s simulated, 1.23 GB written; 1.34 of 5 s in friction=0.3; "
        "1 min 12 s left"
    )
    tally.moment = HALF_WAY._replace(worked=2 * EVERY - 0.1)
    assert state.line() == ""
    tally.moment = HALF_WAY._replace(worked=2 * EVERY)
    assert state.line() != ""
    tally.moment = HALF_WAY._replace(worked=9 * EVERY, cells_done=12)
    assert state.line() == ""


def test_a_stage_after_the_cells_has_its_own_count() -> None:
    state = running(HALF_WAY)
    state.timing("rounds of overheads", 5, 20)
    (line,) = drawn(state)
    assert line.startswith("pile  rounds of overheads  ━")
    assert "5 of 20" in line
    assert state.line() == ""


def test_sizes_and_spans_have_three_digits_at_most() -> None:
    sizes = {0: "0 B", 999: "999 B", 999_999: "1 MB", 1_234_567: "1.23 MB", 5.6e10: "56 GB"}
    assert {count: byte_size(count) for count in sizes} == sizes
    spans = {0.4: "0 s", 59.6: "1 min 0 s", 72.4: "1 min 12 s", 7290.0: "2 h 1 min"}
    spans |= {172799.0: "47 h 59 min", 172800.0: "2 days 0 h", 1e6: "11 days 13 h"}
    assert {seconds: time_span(seconds) for seconds in spans} == spans
