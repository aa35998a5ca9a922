"""Scenes of ten lines, as teachers, game developers and roboticists write in their first hour.

All at the defaults, with `always: {}`. In this folder: those that run to their end, converge in
every step and are warned of in nothing. In `not_yet`: those that do not; each says by itself what
is wrong with it: one that stops at a bound and one whose middles are not found are run, all with
`LAVENDER_TEST_EVERYTHING=1`. One that does no longer belong there fails no test, and is moved by
hand.
"""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import pytest

from lavendersim.runner import load_all, run
from tests.thorough import THOROUGH

HERE = Path(__file__).parent
SCENES = sorted(HERE.glob("*.yaml"))
NOT_YET = sorted((HERE / "not_yet").glob("*.yaml"))
# Scenes whose plan no other scene or config that tests run has; it takes seconds to compile. And
# one that is `lavender new dominoes`, which tests run.
ALONE = {
    "dominoes_of_twenty",
    *("ball_between_walls", "ball_on_a_carpet", "ball_over_a_kerb", "ball_that_spins", "bank_shot"),
    *("block_on_a_catapult", "bouncing_box", "bulldozer", "bungee", "can_and_pipe"),
    *(
        "cart_on_a_slope",
        "cut_shot",
        "damped_spring",
        "drawer",
        "hammer_throw",
        "heap_of_balls",
        "jenga_push",
    ),
    *("lift_going_up", "parachute", "precessing_wheel", "pushed_door", "ragdoll_of_balls"),
    *("seesaw", "stop_shot", "three_logs", "tower_of_cans", "towing", "two_pushed_together"),
    *("tyre_down_stairs", "weight_on_a_spring", "wrecking_ball_on_a_rod"),
}
RUN = [one for one in SCENES if THOROUGH or one.stem not in ALONE]
TELLING = [one for one in NOT_YET if THOROUGH or one.stem == "wall_in_bond"]
# A bound that was broken, by how much, whose, and when.
STOPPED = re.compile(r"beyond bounds: \w+ \S+ .*, at most \S+,.* in step \d+ \(t = \S+ s\)")


def named(files: list[Path]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("file", files, ids=[file.stem for file in files])


def test_there_are_scenes_of_ten_lines_or_so() -> None:
    assert len(SCENES) >= 100
    assert {file.stem for file in SCENES} >= ALONE
    assert [file.name for file in SCENES + NOT_YET if len(file.read_text().split("\n")) > 15] == []


def test_a_scene_that_is_not_right_says_what_is_wrong() -> None:
    said = [re.search(r"^always: \{.*?\} # .*\d", file.read_text(), re.M) for file in NOT_YET]
    assert all(said)


@named(SCENES + NOT_YET)
def test_a_scene_says_nothing_of_how_it_is_simulated(file: Path) -> None:
    text = file.read_text()
    assert text.startswith("question: ")
    assert "numerics" not in text
    assert "\nalways: {" in text
    assert "stop: false" not in text


@named(RUN)
def test_a_scene_runs_converges_and_is_warned_of_in_nothing(file: Path, tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        (experiment,) = load_all([file], strict=True)
        finished = run(experiment, tmp_path, 1)
    assert [one.message for one in finished.verdicts if not one.passed] == []
    assert finished.good
    assert finished.not_converged == []


@named(TELLING)
def test_what_is_not_right_is_said_with_its_place(file: Path, tmp_path: Path) -> None:
    (experiment,) = load_all([file], strict=True)
    finished = run(experiment, tmp_path, 1)
    for cell in finished.ended_early:
        assert STOPPED.fullmatch(cell.status), cell.status
    for outcome in finished.outcomes:
        worst = outcome.accuracy
        is_missed = worst.not_converged > 0
        assert is_missed == (worst.worst_residual > worst.tolerance)
        missed = [one for one in finished.not_converged if "above the tolerance" in one]
        assert len(missed) == int(is_missed)
        # And one of what took all its iterations.
        assert len(finished.not_converged) == int(is_missed) + int(bool(worst.at_limit))
