"""Bounds while a cell runs: blocks end with the first step beyond one, as its log would."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from lavendersim.measures import step_passes
from lavendersim.measures.specs.always import Always
from lavendersim.record_tables import copied
from lavendersim.runner import bounds
from lavendersim.runner.bounds import Bounds
from lavendersim.trace import Block
from tests.made_cells import made_cell

BODIES = {"still": {"shape": {"kind": "sphere", "radius": 0.1}}, "ball": {"shape": {"kind": "sphere", "radius": 0.1}}}  # noqa: E501  # fmt: skip
CONFIG = made_cell(BODIES, numerics={"timestep": "1/100"})
STEPS = 30
NO_CONTACTS = {"/contacts": "nothing can touch"}
SUMS = ("residual", "kinetic_energy", "potential_energy", "momentum_x", "momentum_y", "momentum_z")


@pytest.fixture(autouse=True)
def _by_numpy(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The passes of numpy give the kernels' bits (`test_step_passes_kernel`), uncompiled."""
    monkeypatch.setattr(bounds, "step_passes_kernel", step_passes)
    return


def run() -> Block:
    """A ball that is k + 0.5 m/s fast in step k: faster than 10 m/s first in step 10."""
    step = np.zeros(
        STEPS,
        [
            ("step", "i8"),
            ("time_ns", "i8"),
            ("residual_contact", "i8"),
            *((name, "f8") for name in SUMS),
        ],
    )
    step["step"], step["time_ns"] = np.arange(STEPS), np.arange(STEPS) * 10_000_000
    pose = np.zeros((STEPS, 2, 7))
    pose[:, :, 3] = 1.0
    ways = 0.01 * (np.arange(1, STEPS) + 0.5)
    pose[1:, 1, 0] = np.cumsum(ways)
    residual = np.zeros(STEPS, [("step", "i8"), ("sweep", "i8"), ("residual", "f8")])
    residual["step"] = step["step"]
    return Block(step, np.zeros(0, [("step", "i8")]), pose, residual)


def made(**always: object) -> Bounds:
    given = {"energy": "none", "momentum": "none", "impulses": "none", "penetration": "none"}
    spec = Always.model_validate({**given, **always})
    return Bounds(spec, list(BODIES), CONFIG, CONFIG.clock, NO_CONTACTS)


@pytest.mark.parametrize("room", [False, True])
@pytest.mark.parametrize("size", [1, 7, 30])
def test_a_run_ends_with_the_step_that_breaks_its_bound_whatever_the_blocks(
    size: int, room: bool
) -> None:
    """Whether the state before is copied in front of a block, or has room there."""
    checked, whole = made(speed=10.0), run()
    for begin in range(0, STEPS, size):
        end = begin + size
        step, pose = copied(whole.step[begin:end], room), copied(whole.pose[begin:end], room)
        part = Block(step, whole.contact, pose, whole.residual[begin:end])
        kept, sentence = checked.within(part, room=room)
        if sentence:
            break
        assert kept.step.tobytes() == whole.step[begin:end].tobytes()
        assert kept.pose.tobytes() == whole.pose[begin:end].tobytes()
    assert kept.step["step"][-1] == kept.residual["step"][-1] == 10
    assert len(kept.pose) == len(kept.step)
    assert sentence == ("beyond bounds: speed 10.5 m/s, at most 10, ball, in step 10 (t = 0.1 s)")
    assert checked.worst is not None
    outcome = checked.worst.outcomes(sentence, _cell())["speed"]
    assert outcome.measured == pytest.approx(10.5)


def _cell():
    from pathlib import Path
    from types import SimpleNamespace

    return SimpleNamespace(index=0, label="", path=Path("run/cells/a.mcap"))


def test_without_a_stop_the_run_goes_on_and_its_worst_state_is_known() -> None:
    checked = made(speed=10.0, stop=False)
    block = run()
    assert checked.within(block) == (block, "")
    assert checked.worst is not None
    outcome = checked.worst.outcomes("complete", _cell())["speed"]
    assert outcome.measured == pytest.approx(29.5)
    assert "first in step 10" in outcome.reason


def test_the_first_of_two_broken_bounds_is_said() -> None:
    block = run()
    block.step["residual"][8] = 1.0
    kept, sentence = made(speed=10.0, residual=0.5).within(block)
    assert (len(kept.step), sentence.split(" ")[2]) == (9, "residual")
    block.step["residual"][8], block.step["residual"][12] = 0.0, 1.0
    _, sentence = made(speed=10.0, residual=0.5).within(block)
    assert sentence.split(" ")[2] == "speed"


def test_a_state_that_is_no_number_breaks_no_bound_and_counts_where_the_engine_went_on() -> None:
    block = run()
    block.step["kinetic_energy"][29] = np.nan
    for diverged, finite in ((True, 0.0), (False, 1.0)):
        checked = made(speed=99.0)
        assert checked.within(block, diverged) == (block, "")
        assert checked.worst is not None
        assert checked.worst.outcomes("complete", _cell())["finite"].measured == finite


def test_without_a_section_nothing_is_looked_at() -> None:
    checked = Bounds(None, list(BODIES), CONFIG, CONFIG.clock, NO_CONTACTS)
    block = run()
    assert checked.within(block) == (block, "")
    assert checked.worst is None
