"""An engine between its steps: memory that grows gives the same rows, and bodies are taken out.

Its step runs in the interpreter: nothing is compiled.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from interpreted import records
from interpreted_steps import Steps
from laboratory import plane, resolved, sphere

from lavendersim.engine import engine as engines
from lavendersim.engine import memory
from lavendersim.engine.engine import Engine
from lavendersim.engine.record_layout import (
    allocate_bodies,
    allocate_pairs,
    allocate_parameters,
    allocate_velocities,
)
from lavendersim.engine.records import CONTACTS_FULL, DIVERGED, ROWS_FULL, RUNNING, WOKEN
from lavendersim.engine.spec import Spec

RADIUS = 0.1


def heap(count: int = 4, block_steps: int = 8, **numerics: Any) -> Engine:
    """Return an engine of balls on each other on a floor, whose step is interpreted."""
    bodies: dict[str, Any] = {"floor": plane()}
    for k in range(count):
        bodies[f"ball {k}"] = sphere(RADIUS, (0.0, 0.0, (2 * k + 1) * RADIUS))
    known = {"timestep": 0.01, "tolerance": 1e-10, "sweeps": 300, **numerics}
    return interpreted_engine(resolved(bodies, (0.0, 0.0, -10.0), **known), block_steps)


def interpreted_engine(cell: dict[str, Any], block_steps: int = 8) -> Engine:
    steps = Steps(cell)
    engine = steps.bench.scene.engine(steps.spec, block_steps)

    def entry(*arguments: Any) -> int:
        *arrays, count = arguments
        with np.errstate(over="ignore"):
            return int(steps._advance(*(records(array) for array in arrays), count))

    engine._entry = entry
    return engine


def rows_of(engine: Engine, steps: int) -> dict[str, bytes]:
    """Return all rows of so many steps, whatever blocks they come in."""
    found: dict[str, bytes] = dict.fromkeys(engines.Rows._fields, b"")
    target = int(engine.counters["step"][0]) + steps
    while True:
        status = engine.advance(target - int(engine.counters["step"][0]))
        for name, rows in engine.take_rows()._asdict().items():
            found[name] += rows.tobytes()
        if status != ROWS_FULL:
            assert status == RUNNING
            return found


def test_rows_do_not_depend_on_the_room_that_there_was() -> None:
    """Of contacts, of pairs and of the log: a step whose memory is full is made anew."""
    expected = rows_of(heap(), 12)
    for capacity in (1, 2, 3):
        engine = heap()
        state = engine.state
        contacts, cache = state.contacts[:capacity].copy(), state.cache[:capacity].copy()
        engine.state = state._replace(contacts=contacts, cache=cache)
        engine.workspace = memory.for_contacts(engine.spec, engine.workspace, engine.state)
        engine.log = engine._allocate_log()
        assert rows_of(engine, 12) == expected
        assert len(engine.contacts) >= 4
    assert rows_of(heap(block_steps=3), 12) == expected
    short = heap()
    short.log = short.log._replace(contact=short.log.contact[:2])
    assert rows_of(short, 12) == expected


def test_contacts_that_are_cached_outlive_a_larger_memory() -> None:
    engine = heap()
    engine.advance(3)
    kept = engine.state.cache[:4].tobytes()
    engine.take_rows()
    engine._grow_contacts(50)
    assert engine.state.cache[:4].tobytes() == kept
    assert len(engine.state.cache) == len(engine.contacts) == 50
    assert engine.counters["cached"][0] == 4


def test_statuses_of_the_step_are_answered() -> None:
    """Woken and enlarged it is called again for what is left; diverged it is not."""
    engine = heap()
    said, asked = [WOKEN, CONTACTS_FULL, DIVERGED], []

    def entry(*arguments: Any) -> int:
        asked.append(arguments[-1])
        engine.counters["step"] += 1
        return said.pop(0)

    engine._entry = entry
    capacity = len(engine.contacts)
    assert engine.advance(10) == DIVERGED
    assert asked == [10, 9, 8]
    assert len(engine.contacts) == 2 * capacity


def test_rows_are_taken_before_contacts_grow() -> None:
    """Larger columns would drop them."""
    engine = heap()
    engine.advance(2)
    capacity = len(engine.contacts)
    engine._entry = lambda *arguments: CONTACTS_FULL
    assert engine.advance(1) == ROWS_FULL
    assert len(engine.contacts) == capacity
    assert len(engine.take_rows().step) == 3


@pytest.mark.parametrize("share", [0.75, 0.25])
def test_rows_that_fill_their_memory_are_handed_on_in_it(share: float, monkeypatch) -> None:
    """The next go elsewhere; where less than half of it is in use, rows are copied."""
    engine = heap()
    engine.advance(5)
    count = int(engine.counters["contact_rows"][0])
    expected = engine.log.contact[:count].copy()
    memory_of_it = np.zeros(int(count / share), engine.log.contact.dtype)
    memory_of_it[:count] = expected
    engine.log = engine.log._replace(contact=memory_of_it)
    monkeypatch.setattr(engines, "HANDED_ON", 1)
    taken = engine.take_rows().contact
    assert np.shares_memory(taken, memory_of_it) == (share > 0.5)
    assert np.shares_memory(engine.log.contact, memory_of_it) == (share <= 0.5)
    assert len(engine.log.contact) == len(memory_of_it)
    assert len(taken) == count > 0
    engine.advance(5)
    assert int(engine.counters["contact_rows"][0]) > 0
    for name in expected.dtype.names or ():
        assert taken[name].tobytes() == expected[name].tobytes()


def test_rows_that_are_taken_are_copies_and_are_gone() -> None:
    engine = heap()
    engine.advance(2)
    first = engine.take_rows()
    assert (len(first.step), first.pose.shape) == (3, (3, 5, 7))
    assert first.step["step"].tolist() == [0, 1, 2]
    kept = first.step.copy()
    engine.advance(1)
    second = engine.take_rows()
    assert second.step["step"].tolist() == [3]
    assert first.step.tobytes() == kept.tobytes()
    assert [len(rows) for rows in engine.take_rows()] == [0, 0, 0, 0]


def test_the_rows_of_a_step_of_which_parts_are_left_stay() -> None:
    engine = heap()
    engine.advance(1)
    log, counters = engine.log, engine.counters
    counters["parts"], counters["step_rows"], counters["contact_rows"] = 2, 1, 3
    log.step["contact_count"][1], log.step["residual"][1] = 2, 0.25
    log.contact["step"][:5] = [1, 1, 1, 2, 2]
    log.residual["step"][:3], counters["residual_rows"] = [1, 2, 2], 3
    counters["step"] = 1
    rows = engine.take_rows()
    assert (len(rows.step), rows.contact["step"].tolist()) == (1, [1, 1, 1])
    assert rows.residual["step"].tolist() == [1]
    assert engine.log.contact["step"][:2].tolist() == [2, 2]
    assert engine.log.step["residual"][0] == 0.25
    assert engine.log.residual["step"][:2].tolist() == [2, 2]
    assert engine.counters["residual_rows"][0] == 2


def test_impulses_of_one_body_or_of_all_are_forgotten() -> None:
    engine = heap()
    engine.advance(2)
    cache = engine.state.cache
    assert engine.counters["cached"][0] == 4
    engine.forget_contacts(2)
    left = cache[: engine.counters["cached"][0]]
    assert [(int(row["a"]), int(row["b"])) for row in left] == [(0, 1), (3, 4)]
    engine.forget_contacts()
    assert engine.counters["cached"][0] == 0
    engine.forget_contacts(1)  # nothing is there


def test_a_body_that_is_taken_out_leaves_all_pairs_and_holds_nothing() -> None:
    """What stood on it falls; it stays where it is."""
    engine = heap(3)
    engine.advance(2)
    place = float(engine.bodies["z"][1])
    engine.remove(1)
    assert 1 not in {*engine.state.pairs["a"].tolist(), *engine.state.pairs["b"].tolist()}
    engine.advance(4)
    assert engine.bodies["z"][1] == place
    assert engine.velocities["vz"][2] == pytest.approx(-0.4, abs=1e-9)


def test_what_sleeps_is_woken_by_a_change_beside_it() -> None:
    engine = heap(2, sleeping=True, sleep_time=0.02)
    engine.advance(6)
    assert engine.bodies["asleep"].tolist() == [0, 1, 1]
    engine.wake_all()
    assert engine.bodies["asleep"].tolist() == [0, 0, 0]
    engine.take_rows()
    engine.advance(6)
    assert engine.bodies["asleep"].tolist() == [0, 1, 1]
    engine.wake(2)
    assert engine.bodies["asleep"][2] == 0
    awake = heap(1)
    awake.wake_all()
    awake.wake(1)


def test_a_missing_effect_of_another_is_named() -> None:
    spec = Spec(effects=("sliding_stops",))
    with pytest.raises(ValueError, match="sliding_stops needs"):
        Engine(
            spec,
            allocate_bodies(spec, 1),
            allocate_velocities(spec, 1),
            allocate_pairs(spec, 0),
            allocate_parameters(),
            np.zeros((1, 7)),
        )


def test_arrays_differ_as_they_do_to_the_compiler() -> None:
    """By dtype, dimensions, order in memory and whether they may be written; not by their size."""
    types = engines._types_of
    plain = np.zeros((2, 3))
    assert types(plain) == types(np.ones((5, 4)))
    frozen = plain.copy()
    frozen.flags.writeable = False
    for other in (plain[0], plain.astype(np.int64), plain[:, ::2], frozen, 1.0):
        assert types(other) != types(plain)
    assert types((plain, (plain,))) == types((plain, (plain,)))
    assert types((plain, [])) != types((plain, ()))
    assert types((plain,)) != types([plain])


def test_more_sweeps_take_more_room_once_the_rows_are_taken() -> None:
    engine = heap()
    engine.advance(1)
    before = len(engine.log.residual)
    engine.parameters["sweeps"] = before + 5
    assert engine.advance(1) == ROWS_FULL
    engine.take_rows()
    assert engine.advance(1) == RUNNING
    assert len(engine.log.residual) >= before + 6


def test_the_problem_of_the_last_step_is_that_of_its_contacts() -> None:
    """W lambda + q >= 0 of a pile: what it solves is what the step did."""
    cell = resolved(
        {
            "floor": plane(),
            "low": sphere(RADIUS, (0.0, 0.0, RADIUS)),
            "high": sphere(RADIUS, (0.0, 0.0, 3.0 * RADIUS)),
        },
        (0.0, 0.0, -10.0),
        **{"timestep": 0.01, "tolerance": 1e-12, "sweeps": 300},
    )
    cell["record"]["problems"] = "all"
    engine = interpreted_engine(cell)
    assert engine.problem() is None
    engine.advance(1)
    problem = engine.problem()
    assert problem is not None
    impulses = engine.contacts["lambda_n"][:2]
    assert impulses == pytest.approx([0.2, 0.1], abs=1e-10)


@pytest.mark.parametrize(
    "numerics",
    [
        {},
        {"solver": "coloured_gauss_seidel"},
        {"solver": "block_gauss_seidel"},
        {"impacts": "captured", "integrator": "semi_implicit_euler"},
    ],
    ids=["defaults", "coloured", "block", "captured"],
)
def test_engines_of_one_kind_have_arrays_of_equal_types(numerics: dict[str, Any]) -> None:
    # One machine code serves all engines of a kind: it reads their arrays by these types.
    types: dict[int, set[Any]] = {}
    made = [heap(count, steps, **numerics) for count in (1, 2, 3, 9) for steps in (1, 8)]
    for engine in made:
        found = engines._types_of((engine.state, engine.workspace, engine.log))
        types.setdefault(engine.kind, set()).add(found)
    assert all(len(one) == 1 for one in types.values())
    assert len(types) < len(made), "engines that differ in sizes alone have one kind"
