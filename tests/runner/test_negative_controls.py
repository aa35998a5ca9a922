"""`fails`: a control passes when exactly what it names fails, and turns nothing else around."""

from __future__ import annotations

from pathlib import Path

import pytest

import lavendersim
from lavendersim.experiment import load_experiment_text
from lavendersim.measures import judge_nodes
from lavendersim.runner import Finished

# A ball sunk by half its radius: what a gain makes of that is velocity, 0.5 * 0.05 m * 240/s or
# 6 m/s, 18 J where there was nothing; what the projection makes of it, with gain 0, is none.
SUNK = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 0.05]}
numerics: {stabilisation_gain: 0, projection: 0.2}
duration: 0.1
sweep:
  gain: {path: numerics.stabilisation_gain, values: [0, 0.5]}
measure:
  duration: {kind: simulated_duration}
  depth: {kind: max_penetration, body: ball}
"""
# At 1e155 m/s^2 upwards the square of the ball's speed is infinite after 33 steps.
RUNAWAY = """\
scene:
  gravity: [0, 0, 1]
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 1]}
numerics: {stabilisation_gain: 0.5, projection: 0.2}
duration: 0.5
sweep:
  pull: {path: scene.gravity.2, values: [1, 1e155]}
measure:
  duration: {kind: simulated_duration}
"""


def run(folder: Path, text: str) -> Finished:
    config = folder / "control.yaml"
    config.write_text(text)
    finished = lavendersim.run(config, root=folder)
    # what a test runner lists before the run is what the run gives
    listed = judge_nodes(load_experiment_text(text, "control.yaml"))
    assert listed == [verdict.node for verdict in finished.verdicts]
    return finished


def of(finished: Finished, node: str) -> bool:
    (passed,) = [verdict.passed for verdict in finished.verdicts if verdict.node == node]
    return passed


ALWAYS = "always: {penetration: none}\n"


def test_a_control_of_what_fails_passes_and_takes_it_over(tmp_path: Path) -> None:
    control = "expect:\n  - {name: won, fails: energy, at: {gain: 0.5}}\n"
    finished = run(tmp_path, SUNK + ALWAYS + control)
    assert finished.good
    nodes = [verdict.node for verdict in finished.verdicts]
    assert "won at gain=0.5" in nodes
    assert {"always: energy at gain=0", "always: momentum at gain=0.5"} <= set(nodes)
    assert "always: energy at gain=0.5" not in nodes


def test_a_control_of_what_holds_fails(tmp_path: Path) -> None:
    finished = run(tmp_path, SUNK + ALWAYS + "expect:\n  - {name: won, fails: energy}\n")
    assert not finished.good
    assert of(finished, "won at gain=0.5")
    assert not of(finished, "won at gain=0")


def test_a_control_fails_where_something_else_fails_too(tmp_path: Path) -> None:
    control = "always: {}\nexpect:\n  - {name: won, fails: energy, at: {gain: 0.5}}\n"
    finished = run(tmp_path, SUNK + control)  # it is sunk by more than a tenth
    assert not of(finished, "won at gain=0.5")
    (verdict,) = [one for one in finished.verdicts if one.node == "won at gain=0.5"]
    assert "so did always: penetration at gain=0.5" in verdict.message


@pytest.mark.parametrize(
    ("bound", "good"), [("at_most: 0.01", True), ("at_most: 0.06", False)], ids=["bites", "holds"]
)
def test_an_expectation_can_be_what_must_fail(tmp_path: Path, bound: str, good: bool) -> None:
    claims = f"""expect:
  - {{name: shallow, measure: depth, {bound}}}
  - {{name: it is sunk, fails: shallow}}
"""
    finished = run(tmp_path, SUNK + claims)
    assert finished.good is good
    assert [verdict.node for verdict in finished.verdicts] == [
        *("it is sunk at gain=0", "it is sunk at gain=0.5")
    ]


def test_an_expectation_across_cells_can_be_what_must_fail(tmp_path: Path) -> None:
    # every cell lasts as long, so nothing rises along the gain
    claims = """expect:
  - {name: longer, measure: duration, increasing: {along: gain}}
  - {name: not longer, fails: longer}
"""
    finished = run(tmp_path, SUNK + claims)
    assert finished.good
    assert [verdict.node for verdict in finished.verdicts] == ["not longer"]


def test_a_cell_that_must_diverge_fails_nothing_but_completes(tmp_path: Path) -> None:
    claims = """always: {}
expect:
  - {name: lasts, measure: duration, at_least: 0.5}
  - {name: runs away, fails: completes, at: {pull: 1e155}}
"""
    finished = run(tmp_path, RUNAWAY + claims)
    assert finished.outcomes[1].status.startswith("diverged: ")
    assert finished.good
    of_runaway = [one.node for one in finished.verdicts if "1e+155" in one.node]
    assert of_runaway == ["runs away at pull=1e+155"]


def test_a_cell_that_completes_fails_the_control_of_divergence(tmp_path: Path) -> None:
    control = "expect:\n  - {name: runs away, fails: diverges}\n"
    finished = run(tmp_path, RUNAWAY + control)
    assert not of(finished, "runs away at pull=1")
    assert of(finished, "runs away at pull=1e+155")


def test_a_control_of_another_check_does_not_excuse_divergence(tmp_path: Path) -> None:
    # the ball is never as fast as what it is asked to exceed
    control = """always: {penetration: none, speed: 1e200}
expect:
  - {name: fast, fails: speed, at: {pull: 1e155}}
"""
    finished = run(tmp_path, RUNAWAY + control)
    assert not finished.good
    (verdict,) = [one for one in finished.verdicts if one.node == "fast at pull=1e+155"]
    assert not verdict.passed
    assert "a cell did not complete: diverged: body ball" in verdict.message
    assert [cell.label for cell in finished.ended_early] == ["pull=1e+155"]


def test_a_bound_that_a_control_wants_broken_ends_its_cell_there(tmp_path: Path) -> None:
    # 1e155 m/s^2 * dt / 2 in the first step, long before anything is infinite
    control = """always: {penetration: none, speed: 100}
expect:
  - {name: lasts, measure: duration, at_least: 0.5}
  - {name: fast, fails: speed, at: {pull: 1e155}}
"""
    finished = run(tmp_path, RUNAWAY + control)
    assert finished.good
    assert [outcome.steps for outcome in finished.outcomes] == [120, 1]
    assert finished.ended_early == []


def test_a_bound_is_no_divergence_to_a_control(tmp_path: Path) -> None:
    control = """always: {penetration: none, speed: 100}
expect:
  - {name: runs away, fails: diverges, at: {pull: 1e155}}
"""
    finished = run(tmp_path, RUNAWAY + control)
    assert not finished.good
    (verdict,) = [one for one in finished.verdicts if not one.passed]
    assert verdict.node == "runs away at pull=1e+155"
    assert "diverges did not fail" in verdict.message
