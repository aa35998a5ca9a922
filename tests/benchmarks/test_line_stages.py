"""The stages of the line are distinguished, in the cases that are meant."""

from __future__ import annotations

from time import sleep

import pytest

from lavendersim.experiment import load_experiment_text
from tests.benchmarks import line_cases, line_stages


def test_every_function_that_is_wrapped_is_there_and_as_before_afterwards() -> None:
    places = [place for places in line_stages.WRAPPED.values() for place in places]
    before = [line_stages.owner_of(*place) for place in places]
    functions = [getattr(owner, name) for owner, name in before]
    with line_stages.stopwatch() as spent:
        assert all(
            getattr(owner, name) is not function
            for (owner, name), function in zip(before, functions, strict=True)
        )
    assert [getattr(owner, name) for owner, name in before] == functions
    assert spent == dict.fromkeys(line_stages.WRAPPED, 0.0)


def test_a_wrapped_function_returns_and_raises_as_before_and_its_time_is_added() -> None:
    taken: list[float] = []

    def halved(number: int, by: int = 2) -> float:
        sleep(0.01)
        return number / by

    wrapped = line_stages.timed(halved, taken.append)
    assert wrapped(4) == 2.0
    with pytest.raises(ZeroDivisionError):
        wrapped(4, by=0)
    assert len(taken) == 2
    assert min(taken) >= 0.009  # a sleep may end a tick of the clock early


def test_judging_is_taken_out_of_what_cells_report_as_logging() -> None:
    reported = {"kernels": 1.0, "physics": 2.0, "logging": 5.0}
    wrapped = {"opening": 3.0, "judging": 1.5, "measuring": 4.0}
    parts = line_stages.split(20.0, reported, wrapped)
    assert tuple(parts) == line_stages.WITHIN
    assert parts["logging"] == 3.5
    assert parts["rest"] == 20.0 - (1.0 + 2.0 + 3.0 + 3.5 + 1.5 + 4.0)


def test_a_log_grows_as_its_last_quarter_does() -> None:
    # 100 B a step up to step 80, then 300 B: states 80 to 100 are 21.
    chunks = [(0.0, 4000), (40.0, 4000), (80.0, 3000), (90.0, 3300)]
    assert line_stages.growth_of(chunks, 100) == 6300 / 21
    assert line_stages.growth_of([(0.0, 5050)], 100) == 50.0


def test_the_sweep_has_as_many_different_drops_as_asked_for() -> None:
    cells = load_experiment_text(line_cases.drops(40), "drops.yaml").cells()
    assert len({cell.digest for cell in cells}) == 40
    assert {cell.config.steps for cell in cells} == {240}
    with pytest.raises(ValueError, match="a multiple of 20"):
        line_cases.drops(30)


def test_reduced_scenes_are_the_shipped_ones_but_for_their_duration() -> None:
    cases = {case.name: case for case in line_cases.cases(pile_duration=1.5)}
    shipped = (line_cases.SCENES / "pile.yaml").read_text()
    (pile,) = cases["pile"].load()
    (warm,) = cases["pile"].warm()
    assert (pile.cells()[0].config.steps, warm.cells()[0].config.steps) == (360, 24)
    assert pile.text == shipped.replace("duration: 4.0", "duration: 1.5")
    (pyramid,) = cases["pyramid"].load()
    assert pyramid.text == (line_cases.SCENES / "pyramid.yaml").read_text()
    (ball,) = cases["ball of 100000 steps"].load()
    assert ball.cells()[0].config.steps == 100_000
    with pytest.raises(ValueError, match="expected 1"):
        line_cases.lasting("numerics: chapter\n", 1.0)
    with pytest.raises(ValueError, match="more than 1000"):
        line_cases.cases(steps=1000)
