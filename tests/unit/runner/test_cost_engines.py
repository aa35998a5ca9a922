"""A grid of other engines: errors by closed form, times of each, and what one cannot do."""

from __future__ import annotations

import pytest

from lavender_cli.cost import lines_of
from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text
from lavendersim.figures.work_precision import compose
from lavendersim.peers.catalogue import installed_version
from lavendersim.runner import open_run
from lavendersim.runner.cost import Costed, take_cost
from lavendersim.runner.cost_engines import able_engines
from tests.engines import needs

FLIGHT = """\
question: How far off is a flight?
expected: Semi-implicit Euler falls g h t/2 too far.
scene:
  gravity: [0, 0, -10]
  bodies:
    floor: {shape: {kind: plane, offset: -9}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 2, position: [0, 0, 5]}
numerics: {timestep: 1/100}
duration: 0.5
measure:
  fall: {kind: displacement, body: ball, along: [0, 0, -1]}
  laws: {kind: optimality}
expect:
  - {name: no law is broken, measure: laws, at_most: 1e-12}
cost:
  error: {measure: fall, truth: 1.25}  # g t^2/2
  timesteps: [1/50, 1/100]
  repeats: 7
  targets: [0.03, 1e-9]
"""
SHAPES = FLIGHT.replace("{kind: sphere, radius: 0.1}", "{kind: capsule, radius: 0.1, length: 1}")


@pytest.fixture(scope="module")
def costed(tmp_path_factory: pytest.TempPathFactory) -> Costed:
    experiment = load_experiment_text(FLIGHT, "flight.yaml")
    bullet = ("bullet-accurate",) if installed_version("bullet") else ()
    engines = ("mujoco-rk4", "mujoco-cg", *bullet)
    return take_cost(experiment, tmp_path_factory.mktemp("engines"), engines=engines)


@needs("mujoco")
def test_errors_of_engines_are_those_of_their_integrators(costed: Costed) -> None:
    """g h t/2 of g t^2/2: h/t, but for RK4."""
    for row in (row for row in costed.table.rows if row.engine != "mujoco-rk4"):
        h = {"1/50": 0.02, "1/100": 0.01}[row.timestep]
        assert row.error == pytest.approx(h / 0.5, rel=1e-9)
    exact = [row.error for row in costed.table.rows if row.engine == "mujoco-rk4"]
    assert exact == pytest.approx([0.0, 0.0], abs=1e-13)


@needs("mujoco")
def test_a_claim_on_what_an_engine_does_not_report_fails_no_setting(costed: Costed) -> None:
    assert [row.failed for row in costed.table.rows] == [""] * len(costed.table.rows)


@needs("mujoco")
def test_every_setting_is_timed_and_the_table_is_read_and_drawn_as_it_was(costed: Costed) -> None:
    table = costed.table
    for row in table.rows:
        assert len(row.samples) == table.repeats
        assert min(row.samples) > 0.0
        assert row.timed_seconds == pytest.approx(0.5)
    run = costed.finished.run
    assert open_run(None, run.path.parent).cost() == table
    figure = compose(table)
    assert figure.axes[0].get_title(loc="left") == "MuJoCo"


@needs("mujoco")
def test_a_target_has_an_answer_of_each_engine_and_a_sentence_of_all(costed: Costed) -> None:
    engines = costed.table.engines
    assert len(costed.table.targets) == 2 * len(engines)
    finest = [one for one in costed.table.targets if one.target == 1e-9]
    assert [(one.engine, one.reached) for one in finest] == [
        (engine, engine == "mujoco") for engine in engines
    ]
    assert finest[0].fragment is not None
    assert finest[0].fragment.startswith("engine: mujoco-rk4\n")
    if len(engines) > 1:
        said = costed.table.sentences[1]
        assert said.startswith("1e-07 % costs per simulated second: MuJoCo ")
        assert said.endswith("Bullet not reached (at best 2 %)")


def test_an_engine_that_cannot_do_the_scene_is_refused_and_the_others_go_on() -> None:
    experiment = load_experiment_text(SHAPES, "shapes.yaml")
    able, refused = able_engines(experiment, ("mujoco", "rapier", "bullet"))
    assert able == ("mujoco", "bullet")
    assert refused["rapier"].startswith("shape: Rapier has no capsule here")
    with pytest.raises(ConfigError, match="Rapier has no capsule"):
        able_engines(experiment, ("rapier",))


def test_without_a_choice_the_engine_is_the_configs() -> None:
    assert able_engines(load_experiment_text(FLIGHT, "f.yaml"), ()) == (("lavender",), {})
    own = load_experiment_text(f"{FLIGHT}engine: bullet\n", "f.yaml")
    assert able_engines(own, ()) == (("bullet",), {})


@needs("mujoco")
def test_contacts_and_iterations_stand_beside_time_where_an_engine_reports_them(
    costed: Costed,
) -> None:
    """A ball in flight has none; RK4 reports no contacts; efforts say what these are."""
    table = costed.table
    reported = {row.engine: (row.contacts, row.iterations) for row in table.rows}
    assert reported["mujoco-rk4"] == (None, 0.0)
    assert reported["mujoco-cg"] == (0.0, 0.0)
    assert table.efforts.keys() == {row.engine for row in table.rows}
    assert "512 MB" in table.efforts["mujoco-cg"]
    (line,) = {one for one in lines_of(table) if one.strip().startswith("mujoco-rk4: iterations")}
    assert "of its last stage" in line
    assert "not reported" in next(one for one in lines_of(table) if "mujoco-rk4  " in one)
