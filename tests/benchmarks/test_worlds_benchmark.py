"""The benchmark of many worlds runs the same steps with one process and two, and holds its bar."""

from __future__ import annotations

import pytest

from lavendersim.runner import executor
from tests.benchmarks import worlds
from tests.benchmarks.worlds import Taken, missed, ratios


def test_every_case_is_run_with_one_process_and_with_two(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executor, "WORTH_PROCESSES", 0.0)  # few cells would start none
    configs = worlds.cases(0.001)  # 20 drops are the fewest, two stacks
    found = worlds.measure(configs, 1)
    assert {name: pairs[0][0].worlds for name, pairs in found.items()} == {
        "drops": 20,
        "stacks of six": 2,
    }
    for ((one, many),) in found.values():
        assert one.steps == many.steps == 240 * one.worlds
        assert one.others == 0.0  # it starts no process,
        assert many.others > 0.0  # and the processes that are started are waited for
    assert len(list(worlds.lines_of(found))) == 1 + len(configs)
    assert worlds.apart(configs["drops"], 1) > 0.0
    one, more = worlds.in_one_call(configs["drops"], 3, 1)
    assert min(one, more) > 0.0


def test_ratios_are_of_throughput_and_bounded_by_processor_time() -> None:
    alone = Taken(10, 1000, wall=10.0, own=9.0, others=0.0)
    shared = Taken(10, 1000, wall=5.0, own=1.0, others=9.0)
    # 100 steps a second against 200; 9 s of one core against (1 + 9) / 2 = 5 s of two
    assert ratios([(alone, shared)]) == pytest.approx((2.0, 1.8))
    # of which one core does 1 s while the other has nothing to do: 1 s, and (0 + 9) / 2
    assert ratios([(alone, shared._replace(serial=1.0))])[1] == pytest.approx(9.0 / 5.5)
    # one process that plans and judges for 6 s is no faster than that, whatever the others do
    planning = Taken(10, 1000, wall=5.0, own=6.0, others=4.0)
    assert ratios([(alone, planning)])[1] == pytest.approx(1.5)


def test_of_repeats_the_least_counts() -> None:
    alone, shared = Taken(10, 1000, 10.0, 9.0, 0.0), Taken(10, 1000, 5.0, 1.0, 9.0)
    slower = [one._replace(wall=3 * one.wall, own=3 * one.own) for one in (alone, shared)]
    pairs = [(alone, slower[1]), (slower[0], shared)]  # something else ran meanwhile
    assert ratios(pairs) == ratios([(alone, shared)])


def test_a_ratio_below_the_bar_is_said() -> None:
    alone = Taken(10, 1000, 10.0, 9.0, 0.0)
    at, below = (Taken(10, 1000, 10.0 / ratio, 1.0, 9.0) for ratio in (1.8, 1.79))
    assert missed({"drops": [(alone, at)]}) == []
    assert missed({"drops": [(alone, below)]}) == [
        "drops: 1.79 times the throughput of one process, at least 1.8"
    ]
