"""Compile times: what is kept is not taken again, what is missing one kernel a process."""

from __future__ import annotations

from concurrent.futures import Executor, Future
from typing import Any, ClassVar

import pytest

from lavendersim.engine import step
from lavendersim.engine.spec import Spec
from lavendersim.runner import compile_times as module
from lavendersim.runner.compile_times import compile_times
from tests.made_cells import made_cell

CONFIG = made_cell({"ball": {"shape": {"kind": "sphere", "radius": 0.1}}})
SPECS = [Spec(effects=effects) for effects in ((), ("gravity",), ("gravity", "drag"))]


class Pool(Executor):
    """Notes how it is made, and compiles at once."""

    made: ClassVar[list[dict[str, Any]]] = []

    def __init__(self, workers: int, context: Any, **given: Any) -> None:
        self.made.append({"workers": workers, "method": context.get_start_method(), **given})

    def submit(self, function: Any, /, *given: Any, **more: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(function(*given, **more))
        return future


@pytest.fixture(autouse=True)
def _pool(monkeypatch: pytest.MonkeyPatch) -> None:
    Pool.made = []
    monkeypatch.setattr(module, "ProcessPoolExecutor", Pool)
    monkeypatch.setattr(module, "compile_anew", lambda config, spec: 1.0 + len(spec.effects))


def test_only_what_is_not_known_is_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    known = {SPECS[1]: 0.25}
    monkeypatch.setattr(module, "_known", lambda config, specs: dict(known))
    said: list[tuple[int, int]] = []
    times = compile_times(CONFIG, SPECS, 8, lambda done, of: said.append((done, of)))
    assert times == {SPECS[0]: 1.0, SPECS[1]: 0.25, SPECS[2]: 3.0}
    assert said == [(0, 2), (1, 2), (2, 2)]
    (made,) = Pool.made
    # a process has the parts of what it compiled before: each is spawned, and compiles once
    assert (made["workers"], made["method"], made["max_tasks_per_child"]) == (2, "spawn", 1)


def test_where_all_is_known_no_process_is_started(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_known", lambda config, specs: dict.fromkeys(specs, 0.5))
    said: list[tuple[int, int]] = []
    assert set(compile_times(CONFIG, SPECS, 2, lambda *one: said.append(one)).values()) == {0.5}
    assert Pool.made == said == []


@pytest.mark.parametrize(("workers", "expected"), [(1, 1), (2, 2), (9, 3)])
def test_no_more_processes_than_kernels(
    monkeypatch: pytest.MonkeyPatch, workers: int, expected: int
) -> None:
    monkeypatch.setattr(module, "_known", lambda config, specs: {})
    compile_times(CONFIG, SPECS, workers, lambda done, of: None)
    assert Pool.made[0]["workers"] == expected


def test_what_is_compiled_first_is_said_where_it_takes_more_than_a_minute(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Three of four engines are cold: 54 s; four: 72 s, a minute; each is counted once."""
    specs = [*SPECS, Spec(effects=("gravity", "friction"))]
    kept = {specs[0]}
    monkeypatch.setattr(module, "uncompiled", lambda specs: set(specs) - kept)
    assert module.compiling_ahead(specs * 2) == ""
    kept.clear()
    said = "4 engines are compiled first, once: some 1 min of a processor"
    assert module.compiling_ahead(specs * 2) == said


def test_what_is_interrupted_waits_for_no_engine_that_nothing_compiles_yet(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ends: list[dict[str, bool]] = []
    shutdown = Pool.shutdown

    def ended(pool: Pool, wait: bool = True, *, cancel_futures: bool = False) -> None:
        ends.append({"wait": wait, "cancel_futures": cancel_futures})
        shutdown(pool, wait)

    def interrupted(done: int, of: int) -> None:
        if done == 1:
            raise KeyboardInterrupt

    monkeypatch.setattr(module, "_known", lambda config, specs: {})
    monkeypatch.setattr(Pool, "shutdown", ended)
    with pytest.raises(KeyboardInterrupt):
        compile_times(CONFIG, SPECS, 1, interrupted)
    assert ends[0] == {"wait": False, "cancel_futures": True}


def test_the_folder_of_kernels_is_read_once_for_all_engines(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It may hold tens of thousands of files: of fifty engines, it would take seconds."""
    read = []
    monkeypatch.setattr(step, "kernels_on_disk", lambda: read.append("once") or set())
    monkeypatch.setattr(step, "advance_for", lambda spec: Cold())
    assert step.uncompiled(SPECS * 2) == SPECS
    assert read == ["once"]


class Cold:
    """A kernel that is compiled nowhere."""

    overloads: ClassVar[dict[Any, Any]] = {}

    @property
    def _cache(self) -> Cold:
        return self

    def is_of(self, names: set[str]) -> bool:
        return "cold" in names
