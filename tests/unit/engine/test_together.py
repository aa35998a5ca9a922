"""Engines in one call have the bits that each has alone, of one plan and of several."""

from __future__ import annotations

import pytest

from lavendersim.engine import together
from lavendersim.engine.engine import Engine
from lavendersim.engine.records import ROWS_FULL, RUNNING
from lavendersim.engine.together import advance_together, is_possible
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of_cell
from tests.drop_config import SIX
from tests.unit.engine.test_worlds import assert_same_rows

STEPS = 60
# Boxes that fall onto each other: they touch at more points than there is room for at first.
TOWER = """\
scene:
  bodies: {floor: {shape: {kind: plane}}}
  arrangements:
    block:
      kind: tower
      count: 3
      body: {shape: {kind: box, size: [0.2, 0.2, 0.2]}, mass: 1.0}
duration: 1.0
sweep: {mass: {path: scene.arrangements.block.body.mass, values: [1, 2]}}
"""


def engines() -> list[Engine]:
    """Return engines of two plans at their starts, in turns."""
    found = []
    for text in (SIX, TOWER):
        cells = load_experiment_text(text, "worlds.yaml").cells()[:2]
        spec = plan_of_cell(cells[0]).spec
        found.append([build(cell.config, spec).engine(spec, STEPS + 1) for cell in cells])
    ready = [engine for pair in zip(*found, strict=True) for engine in pair]
    for engine in ready:
        engine.advance(0)
    return ready


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("possible", [True, False])
def test_each_has_the_bits_that_it_has_alone(
    threads: int, possible: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not possible:
        monkeypatch.setattr(together, "is_possible", lambda: False)
    monkeypatch.setattr("lavendersim.engine.engine.FIRST_CONTACTS", 5)  # a tower touches at 12
    alone, all_of_them = engines(), engines()
    seen = set()
    for steps in ([20, 7, 0, 20], *[[STEPS // 4] * 4] * 4):
        statuses = [engine.advance(each) for engine, each in zip(alone, steps, strict=True)]
        found = advance_together(all_of_them, steps, threads)
        assert [one.status for one in found] == statuses
        seen |= {*statuses}
        for one, other in zip(alone, all_of_them, strict=True):
            assert one.counters["step"] == other.counters["step"]
            assert_same_rows(one.take_rows(), other.take_rows())
    assert seen == {RUNNING, ROWS_FULL}  # rows are taken before there is more room
    assert len(all_of_them[3].contacts) > 5
    assert alone[0].counters["step"] == 20 + 4 * (STEPS // 4)


@pytest.mark.skipif(not is_possible(), reason="engines advance one by one here")
def test_those_of_one_plan_are_called_once(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[int] = []
    ready = engines()
    monkeypatch.setattr(Engine, "advance", lambda engine, steps: pytest.fail("by itself"))
    kernel = together.advance_engines()

    def counted(*arguments):
        calls.append(len(arguments[1]))
        return kernel(*arguments)

    monkeypatch.setattr(together, "advance_engines", lambda: counted)
    found = advance_together(ready, [10] * 4)
    assert calls == [2, 2]
    assert all(one.spent > 0 for one in found)


@pytest.mark.skipif(not is_possible(), reason="engines advance one by one here")
def test_when_time_is_up_no_other_begins() -> None:
    ready = engines()[::2]
    found = advance_together(ready, [STEPS] * 2, within=0)
    assert [engine.counters["step"][0] for engine in ready] == [STEPS, 0]
    assert [one.status for one in found] == [RUNNING] * 2
    assert found[0].spent > found[1].spent == 0


def test_none_are_none() -> None:
    assert advance_together([], []) == []
