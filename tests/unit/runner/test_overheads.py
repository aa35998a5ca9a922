"""An overhead is the difference that one effect makes, over the same steps, on a quiet machine."""

from __future__ import annotations

import csv
import json
from itertools import count
from pathlib import Path
from typing import Any

import pytest

from lavendersim.engine.spec import Spec
from lavendersim.errors import ConfigError, TraceError
from lavendersim.experiment import load_experiment_text
from lavendersim.measures.overhead_table import OverheadRow
from lavendersim.runner import load_all, open_run, overheads, run
from lavendersim.runner.overhead_pairs import names_of_effects
from lavendersim.runner.timed_engine import Diverged
from tests.drop_config import LOW
from tests.older_runs import without_digests

OVERHEAD = "overhead: {effects: [gravity, drag, contact_log], repeats: 6}\n"
BALL = f"{LOW}duration: 0.5\n{OVERHEAD}"
EVERY = BALL.replace("[gravity, drag, contact_log]", "all")
PLAIN = 100.0  # [ns/step] of the scene's own plan
COST = {"gravity": 5.0, "drag": 3.0, "contact_log": 40.0}  # [ns/step]; what is not named: 1


class Costed:
    """Stands for `Timed`: a step costs what its effects do, on a machine that gets ever slower."""

    calls = count()

    def __init__(self, resolved: Any, spec: Spec, first: int, steps: int) -> None:
        self.spec, self.contacts = spec, 0.25
        self.motion = b"floats" if not spec.has("gravity") else b"falls"

    def sample(self) -> float:
        cost = PLAIN + sum(COST.get(effect, 1.0) for effect in self.spec.effects)
        return cost + 0.01 * next(self.calls)


@pytest.fixture
def costed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(overheads, "Timed", Costed)
    monkeypatch.setattr(
        overheads,
        "compile_times",
        lambda resolved, specs, workers, progress: {s: float(len(s.effects)) for s in specs},
    )


def rows_of(text: str) -> dict[str, OverheadRow]:
    experiment = load_experiment_text(text, "ball.yaml")
    table = overheads.take_overheads(experiment, overheads.pairs_timed(experiment))
    return {row.effect: row for row in table.rows}


@pytest.mark.usefixtures("costed")
def test_an_overhead_is_the_difference_that_the_effect_alone_makes() -> None:
    for name, row in rows_of(EVERY).items():
        if row.why_not or name.startswith("all effects"):
            continue
        # Off and on are neighbours in a round and take turns: a machine that loses 0.01 ns a sample
        # shifts half of the differences up by that, and half down.
        cost = COST.get(name, 1.0) + (1.0 if name == "step_log" else 0.0)  # its poses come with it
        assert row.timing.overhead.median == pytest.approx(cost, abs=1e-9), name
        assert row.timing.overhead.low == pytest.approx(cost - 0.01, abs=1e-9), name
        assert row.timing.overhead.high == pytest.approx(cost + 0.01, abs=1e-9), name
        assert not row.timing.within_noise
        assert row.timing.compile_s_on > row.timing.compile_s_off
        assert len(row.timing.samples_off) == len(row.timing.samples_on) == 6


@pytest.mark.usefixtures("costed")
def test_another_motion_is_called_one_and_a_carried_effect_is_not() -> None:
    rows = rows_of(BALL)
    assert set(rows) == {"gravity", "drag", "contact_log"}
    assert (rows["gravity"].required, rows["gravity"].timing.same_motion) == (True, False)
    assert (rows["drag"].required, rows["drag"].timing.same_motion) == (False, True)


@pytest.mark.usefixtures("costed")
def test_an_overhead_below_the_machines_noise_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    noise = iter([0.0, 9.0, -7.0, 4.0, -6.0, 8.0] * 100)
    monkeypatch.setattr(Costed, "sample", lambda self: PLAIN + next(noise))
    rows = rows_of(BALL)
    assert all(row.timing.within_noise for row in rows.values())


@pytest.mark.usefixtures("costed")
def test_where_an_effect_has_no_overhead_the_row_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    rows = rows_of(EVERY)
    assert set(rows) >= set(names_of_effects())
    assert rows["midpoint"].why_not == "numerics.integrator chooses another law"
    assert rows["fast_bodies"].why_not == (
        "numerics.speculative chooses another law through speculative"
    )
    rows = rows_of(EVERY.replace("numerics: chapter", "numerics: default"))
    assert rows["midpoint"].why_not == "chosen by numerics.integrator: another law without"

    def diverges(resolved: Any, spec: Spec, first: int, steps: int) -> Costed:
        if not spec.has("gravity"):
            raise Diverged
        return Costed(resolved, spec, first, steps)

    monkeypatch.setattr(overheads, "Timed", diverges)
    rows = rows_of(BALL)
    assert rows["gravity"].why_not == "the scene diverges without it"
    assert rows["gravity"].timing is None
    assert rows["drag"].timing.overhead.median == pytest.approx(COST["drag"])


def test_a_run_leaves_its_overheads_in_json_and_csv(tmp_path: Path) -> None:
    config = tmp_path / "ball.yaml"
    config.write_text(BALL.replace("repeats: 6", "repeats: 2"))
    finished = run(config, tmp_path / "runs")
    assert finished.good
    table = open_run(finished.run.path).overheads()
    rows = {row.effect: row for row in table.rows}
    assert set(rows) == {"gravity", "drag", "contact_log"}
    assert (table.bodies, table.steps, table.repeats) == (1, 120, 2)
    for row in rows.values():
        assert row.unit == "body"  # the ball is in the air most of the time
        assert len(row.timing.samples_on) == 2
        assert min(row.timing.samples_off + row.timing.samples_on) > 0.0
        assert min(row.timing.compile_s_off, row.timing.compile_s_on) > 0.0
    gravity = rows["gravity"].timing
    assert [rows[name].timing.same_motion for name in ("drag", "contact_log")] == [True, True]
    assert (gravity.same_motion, gravity.contacts_off) == (False, 0.0)
    assert gravity.contacts_on > 0.0
    with (finished.run.path / "overheads.csv").open(newline="") as file:
        written = {row["effect"]: row for row in csv.DictReader(file)}
    assert {name: float(row["overhead"]) for name, row in written.items()} == {
        name: row.timing.overhead.median for name, row in rows.items()
    }
    results = finished.run.path / "results.json"
    assert json.loads(results.read_text())["overheads"] == table.as_data()
    former = results.read_text().replace('"overheads"', '"prices"').replace('"overhead"', '"price"')
    results.write_text(former.replace('"required"', '"called_for"'))
    assert open_run(without_digests(finished.run.path)).overheads() == table
    kept = run(config, tmp_path / "runs", overheads=False)
    assert kept.run.overheads() is None


def test_a_table_of_overheads_that_lacks_a_number_is_damaged(tmp_path: Path) -> None:
    config = tmp_path / "ball.yaml"
    config.write_text(BALL.replace("repeats: 6", "repeats: 2"))
    path = without_digests(run(config, tmp_path / "runs").run.path)
    results = json.loads((path / "results.json").read_text())
    del results["overheads"]["rows"][1]["compile_s_on"]
    (path / "results.json").write_text(json.dumps(results))
    with pytest.raises(TraceError, match=r"overheads: rows\.1\.timing\.compile_s_on: field req"):
        open_run(path).overheads()


def test_names_that_are_no_effects_are_refused_at_their_place(tmp_path: Path) -> None:
    config = tmp_path / "ball.yaml"
    config.write_text(BALL.replace("gravity, drag", "gravty, drag"))
    with pytest.raises(ConfigError) as refused:
        load_all([config])
    (defect,) = refused.value.defects
    assert str(defect) == (
        f'{config}:11:22: overhead.effects: no effect is called "gravty"; did you mean "gravity"?'
    )
