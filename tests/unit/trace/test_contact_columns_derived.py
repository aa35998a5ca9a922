"""Columns that a log leaves to rules come back bit for bit; logs that store them are as before."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from sample import CONFIG, TIMESTEP, run, split, write

from lavendersim.engine.effects import BY_NAME
from lavendersim.errors import TraceError
from lavendersim.experiment import load_experiment_text
from lavendersim.runner import run as run_experiment
from lavendersim.trace import Block, Trace, TraceWriter, open_trace, recover
from lavendersim.trace.contact_columns import DERIVED
from lavendersim.trace.layout import CHANNELS

LEFT = {"force_n", "penetration", "t1x", "t1y", "t1z"}
SPECIAL = [0.0, -0.0, 1e-3, -1e-3, 5e-324, -5e-324, 1e308, -1e308, math.inf, -math.inf, math.nan]

# Friction of every kind, impacts, rest, a wall whose normal has z = 0, a timestep that changes, and
# a contact without friction beside those with it.
SCENE = """\
scene:
  surfaces:
    held: {friction: 0.4, torsional_friction: 0.001, rolling_friction: 0.001, restitution: 0.3}
  bodies:
    floor: {shape: {kind: plane}, surface: held}
    ceiling: {shape: {kind: plane, normal: [0, 0, -1], offset: -0.75}, surface: held}
    wall: {shape: {kind: plane, normal: [-1, 0, 0], offset: -0.6}}
    slope: {shape: {kind: plane, normal: [0.3, 0.4, 0.5], offset: -0.4}, surface: held}
    low:
      {shape: {kind: box, size: [0.2, 0.3, 0.2]}, mass: 1.0, surface: held, position: [0, 0, 0.2]}
    high: {shape: {kind: sphere, radius: 0.1}, mass: 2.0, surface: held, position: [0, 0.1, 0.5]}
    fast: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, surface: held, position: [0.3, 0, 0.5],
           velocity: [4, 1, 5]}
events: [{at: 0.3, timestep: 1/777}]
duration: 0.8
"""


OLDER = Path(__file__).parent / "logs" / "every_column_in_points.mcap"  # SCENE, up to 0.4 s


class Run(NamedTuple):
    """A log, and the rows of contacts that the engine gave for it."""

    path: Path
    rows: np.ndarray


@pytest.fixture(scope="module")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """SCENE, run."""
    blocks: list[np.ndarray] = []
    append = TraceWriter.append

    def noted(self: TraceWriter, block: Block) -> None:
        blocks.append(block.contact)
        append(self, block)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(TraceWriter, "append", noted)
        experiment = load_experiment_text(SCENE, "scene.yaml")
        finished = run_experiment(experiment, tmp_path_factory.mktemp("runs"))
    return Run(finished.run.cells[0].path, np.concatenate(blocks))


def test_every_column_has_the_bits_that_the_engine_wrote(simulated: Run) -> None:
    log, rows = open_trace(simulated.path), simulated.rows
    described = log._source.described(CHANNELS["/contact_columns"])
    assert set(json.loads(described["derived"])) == LEFT
    assert len(log.contact) == len(rows) > 500
    assert set(log.timesteps) == {1 / 240, 1 / 777}
    assert {-1.0, 0.0, 1.0} <= set(rows["nz"])  # either side of Duff's frame, and between
    assert (rows["penetration"] > 0).any()
    assert (rows["penetration"] == 0).any()
    assert set(log.contact.dtype.names or ()) == {*(rows.dtype.names or ()), "time"}
    for name in rows.dtype.names or ():
        assert log.contact[name].tobytes() == rows[name].tobytes(), name


def test_an_older_log_is_read_as_it_stands() -> None:
    """It has every column in its points, and the rules give those that are derived now."""
    log = open_trace(OLDER)
    assert log.config.record.contacts == log.config.record.poses == "all"
    assert log._source.schema(CHANNELS["/contact_columns"]) is None
    assert {*LEFT, "impulse_n", "residual"} <= set(log.contact.dtype.names or ())
    assert len(log.contact) > 400
    assert set(log.timesteps) == {1 / 240, 1 / 777}
    timesteps = log.clock.lengths(log.contact["step"])
    for name, derived in DERIVED.items():
        found = derived.value(log.contact, timesteps)
        assert found.tobytes() == log.contact[name].tobytes(), name


@pytest.mark.parametrize("source", ["impulse_n", "separation", "nx"])
def test_another_source_gives_other_columns(source: str) -> None:
    """What the test above holds can be broken: by the last bit of a source."""
    log = open_trace(OLDER)
    rows = log.contact.copy()
    rows[source] = np.nextafter(rows[source], np.inf)
    timesteps = log.clock.lengths(rows["step"])
    changed = {
        name
        for name, derived in DERIVED.items()
        if derived.value(rows, timesteps).tobytes() != log.contact[name].tobytes()
    }
    assert changed == {name for name, derived in DERIVED.items() if source in derived.sources}


def rows_of(**columns: Any) -> dict[str, Any]:
    return {name: np.array(values) for name, values in columns.items()}


def test_penetration_is_what_separation_lacks_of_zero() -> None:
    found = DERIVED["penetration"].value(rows_of(separation=SPECIAL), None)
    for phi, depth in zip(SPECIAL, found.tolist(), strict=True):
        expected = max(0.0 - phi, 0.0)  # of Python, which keeps a NaN in the first place
        assert math.isnan(depth) if math.isnan(phi) else depth == expected
        assert math.isnan(phi) or math.copysign(1.0, depth) == 1.0  # never -0


def test_force_is_impulse_by_timestep() -> None:
    timesteps = np.full(len(SPECIAL), float(TIMESTEP))
    with np.errstate(over="ignore"):
        found = DERIVED["force_n"].value(rows_of(impulse_n=SPECIAL), timesteps)
    # 1e308 N s in 1/240 s is beyond the largest double; Python's own division gives infinity too
    expected = np.array([impulse / (1 / 240) for impulse in SPECIAL])
    assert found.tobytes() == expected.tobytes()


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0.36, -0.48, 0.8)])
def test_tangents_are_duffs(normal: tuple[float, float, float]) -> None:
    """A unit vector across the normal; for (0, 0, +-1) it is (1, 0, 0), as the paper has it."""
    rows = rows_of(nx=[normal[0] + 0.0], ny=[normal[1] + 0.0], nz=[normal[2] + 0.0])
    tangent = [float(DERIVED[f"t1{axis}"].value(rows, None)[0]) for axis in "xyz"]
    # three products and sums of numbers up to 1: some units of 2^-53
    assert math.hypot(*tangent) == pytest.approx(1.0, abs=1e-15)
    assert sum(n * t for n, t in zip(normal, tangent, strict=True)) == pytest.approx(0, abs=1e-15)
    if abs(normal[2]) == 1:
        assert tangent == [1.0, 0.0, 0.0]


def test_a_log_says_by_which_rules_its_columns_come_back(tmp_path: Path) -> None:
    log = open_trace(write(tmp_path / "run.mcap", [run(3)]))
    described = log._source.described(CHANNELS["/contact_columns"])
    rules = json.loads(described["derived"])
    assert set(rules) == LEFT
    assert rules["force_n"] == "impulse_n / timestep"


def test_a_rule_of_another_version_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path / "run.mcap", [run(3)])
    other = DERIVED["force_n"]._replace(rule="2 impulse_n / timestep")
    monkeypatch.setitem(DERIVED, "force_n", other)
    with pytest.raises(TraceError, match=r"column force_n is left to a rule of another version"):
        _ = open_trace(path).contact


def test_a_column_without_its_sources_is_stored(tmp_path: Path) -> None:
    block = run(50)
    block = block._replace(contact=block.contact[["step", "x", "y", "z", "force_n", "t1x"]])
    log = open_trace(write(tmp_path / "run.mcap", [block]))
    assert "derived" not in log._source.described(CHANNELS["/contact_columns"])
    assert log.contact["force_n"].tobytes() == block.contact["force_n"].tobytes()


def test_every_rule_is_of_columns_of_its_effect_or_of_all_contacts() -> None:
    """Where an effect is there, so are the sources of what it leaves to a rule."""
    of_all = {column.name for column in BY_NAME["contact_log"].contact_columns}
    for effect in BY_NAME.values():
        own = {column.name for column in effect.contact_columns}
        for column in effect.contact_columns:
            assert column.derived is None or {*column.derived.sources} <= own | of_all


def test_a_killed_run_of_many_contacts_gives_a_prefix(tmp_path: Path) -> None:
    """Its groups have several chunks of contacts each, and all of a group count or none."""
    steps, block = 700, run(700, contacts=250)
    whole = write(tmp_path / "run.mcap", [block]).read_bytes()
    saved = set()
    for share in (0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9):
        (tmp_path / "cut.mcap").write_bytes(whole[: int(share * len(whole))])
        try:
            report = recover(tmp_path / "cut.mcap", tmp_path / "out.mcap")
        except TraceError:
            saved.add(0)
            continue
        log: Trace = open_trace(tmp_path / "out.mcap", allow_incomplete=True)
        part = split(block, [report.steps])[0]
        assert log.pose.tobytes() == part.pose.tobytes()
        for name in part.contact.dtype.names or ():
            assert log.contact[name].tobytes() == part.contact[name].tobytes()
        counted = open_trace(tmp_path / "out.mcap", allow_incomplete=True)._source._index.counts  # type: ignore[attr-defined]
        assert counted[3] == counted[4] == report.steps
        assert counted[9] > 1
        saved.add(report.steps)
        (tmp_path / "out.mcap").unlink()
    assert len(saved) > 2
    assert max(saved) < steps
    assert CONFIG.clock.timestep == TIMESTEP
